#include "coordinator/channel/udp/udp_channel.h"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "coordinator/channel/json/json_channel.h"
#include "coordinator/channel/udp/udp_socket.h"

namespace tcs {
namespace {

std::string NameOf(const UdpEndpoint& endpoint) {
  return fmt::format("{}:{}", endpoint.host, endpoint.port);
}

class UdpSender final : public DatagramSender {
 public:
  UdpSender(UdpSocket socket, UdpEndpoint to) : socket_(std::move(socket)), to_(std::move(to)) {}

  bool Send(const std::string& datagram) override {
    return !socket_.SendTo(to_, datagram).has_value();
  }
  shm::ReceiverAddress To() const override { return KernelAddressOf(to_); }
  // It is enough that the address has been bound once.
  bool IsHeard() override { return is_heard_ = is_heard_ || IsListenedTo(to_); }
  std::string WhyUnheard() const override {
    if (IsListenedTo(to_)) return {};
    return fmt::format(
        "no program listens on {}, so the samples for it are lost; let a client bind that port",
        NameOf(to_));
  }

 private:
  UdpSocket socket_;
  UdpEndpoint to_;
  bool is_heard_ = false;
};

class UdpReceiver final : public DatagramReceiver {
 public:
  UdpReceiver(UdpSocket socket, UdpEndpoint from)
      : socket_(std::move(socket)), from_(std::move(from)) {}

  int fd() const override { return socket_.fd(); }
  std::vector<std::string> ReceiveAll() override {
    std::vector<std::string> all;
    for (;;) {
      auto received = socket_.Receive();
      auto* datagram = std::get_if<std::optional<Datagram>>(&received);
      if (datagram == nullptr || !datagram->has_value()) return all;
      all.push_back(std::move((*datagram)->payload));
    }
  }
  std::string Where() const override { return "on " + NameOf(from_); }

 private:
  UdpSocket socket_;
  UdpEndpoint from_;
};

}  // namespace

Opened<Outlet> OpenUdpOutlet(const UdpEndpoint& to, const std::vector<SensorField>& fields) {
  auto socket = UdpSocket::ForSending();
  if (const auto* error = std::get_if<SocketError>(&socket)) return error->message;
  return std::make_unique<JsonOutlet>(
      std::make_unique<UdpSender>(std::move(std::get<UdpSocket>(socket)), to), fields);
}

Opened<Inlet> OpenUdpInlet(const UdpEndpoint& from, std::size_t channel) {
  auto socket = UdpSocket::Bind(from);
  if (const auto* error = std::get_if<SocketError>(&socket)) return error->message;
  return std::make_unique<JsonInlet>(
      std::make_unique<UdpReceiver>(std::move(std::get<UdpSocket>(socket)), from), channel);
}

}  // namespace tcs
