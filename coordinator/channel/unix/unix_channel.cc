#include "coordinator/channel/unix/unix_channel.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "coordinator/channel/json/json_channel.h"
#include "coordinator/channel/unix/unix_socket.h"

namespace tcs {
namespace {

class UnixSender final : public DatagramSender {
 public:
  UnixSender(UnixSocket socket, UnixName to) : socket_(std::move(socket)), to_(std::move(to)) {}

  bool Send(const std::string& datagram) override { return socket_.SendTo(to_, datagram); }
  shm::ReceiverAddress To() const override { return KernelAddressOf(to_); }
  std::string WhyUnheard() const override {
    if (IsListenedTo(to_)) return {};
    return fmt::format(
        "no program has bound the UNIX socket {}, so the samples for it are lost; let a client "
        "bind it",
        to_.Text());
  }

 private:
  UnixSocket socket_;
  UnixName to_;
};

class UnixReceiver final : public DatagramReceiver {
 public:
  UnixReceiver(UnixSocket socket, UnixName from)
      : socket_(std::move(socket)), from_(std::move(from)) {}

  int fd() const override { return socket_.fd(); }
  std::vector<std::string> ReceiveAll() override { return socket_.ReceiveAll(); }
  std::string Where() const override { return "on the UNIX socket " + from_.Text(); }

 private:
  UnixSocket socket_;
  UnixName from_;
};

}  // namespace

Opened<Outlet> OpenUnixOutlet(const UnixName& to, const std::vector<SensorField>& fields) {
  auto socket = UnixSocket::ForSending();
  if (auto* error = std::get_if<std::string>(&socket)) return std::move(*error);
  return std::make_unique<JsonOutlet>(
      std::make_unique<UnixSender>(std::move(std::get<UnixSocket>(socket)), to), fields);
}

Opened<Inlet> OpenUnixInlet(const UnixName& from, std::size_t channel) {
  auto socket = UnixSocket::Bind(from);
  if (auto* error = std::get_if<std::string>(&socket)) return std::move(*error);
  return std::make_unique<JsonInlet>(
      std::make_unique<UnixReceiver>(std::move(std::get<UnixSocket>(socket)), from), channel);
}

}  // namespace tcs
