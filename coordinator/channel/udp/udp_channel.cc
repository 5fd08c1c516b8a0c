#include "coordinator/channel/udp/udp_channel.h"

#include <fmt/format.h>

#include <optional>
#include <string>

#include "coordinator/channel/json/json_codec.h"

namespace tcs {
namespace {

std::string NameOf(const UdpEndpoint& endpoint) {
  return fmt::format("{}:{}", endpoint.host, endpoint.port);
}

}  // namespace

std::variant<std::unique_ptr<Outlet>, SocketError> UdpOutlet::Open(const UdpEndpoint& to) {
  auto socket = UdpSocket::ForSending();
  if (auto* error = std::get_if<SocketError>(&socket)) return std::move(*error);
  return std::unique_ptr<Outlet>(new UdpOutlet(std::move(std::get<UdpSocket>(socket)), to));
}

bool UdpOutlet::Send(const Reading& reading, VirtualTime arrives) {
  on_the_way_.Add(EncodeReading(reading), arrives);
  return false;
}

// A full or absent receiver loses the datagram, as on a network.
bool UdpOutlet::HandOver(VirtualTime now) {
  return on_the_way_.Arrive(
      now, [this](const std::string& datagram) { (void)socket_.SendTo(to_, datagram); });
}

std::string UdpOutlet::WhyUnheard() const {
  if (IsListenedTo(to_)) return {};
  return fmt::format(
      "nobody listens on {}, so that its samples are lost; let a client bind that port",
      NameOf(to_));
}

std::variant<std::unique_ptr<Inlet>, SocketError> UdpInlet::Open(const UdpEndpoint& from,
                                                                 std::size_t channel) {
  auto socket = UdpSocket::Bind(from);
  if (auto* error = std::get_if<SocketError>(&socket)) return std::move(*error);
  return std::unique_ptr<Inlet>(
      new UdpInlet(std::move(std::get<UdpSocket>(socket)), from, channel));
}

void UdpInlet::Receive(VirtualTime now, CommandSink& sink) {
  for (;;) {
    auto received = socket_.Receive();
    const auto* datagram = std::get_if<std::optional<Datagram>>(&received);
    if (datagram == nullptr || !datagram->has_value()) return;
    const auto wrench = DecodeCommand((*datagram)->payload);
    if (const auto* error = std::get_if<DecodeError>(&wrench)) {
      sink.Refuse(channel_, "the command datagram " + error->message);
    } else {
      sink.Take(channel_, now, std::get<Wrench>(wrench));
    }
  }
}

Inlet::Place UdpInlet::PlaceOf(std::size_t) const {
  return {"on " + NameOf(from_), "send its commands there"};
}

}  // namespace tcs
