// Sensors and commands as JSON (json/json_codec.h), a UDP datagram each.
#pragma once

#include <memory>
#include <utility>
#include <variant>

#include "coordinator/channel/channel.h"
#include "coordinator/channel/on_the_way.h"
#include "coordinator/channel/udp/udp_socket.h"
#include "coordinator/scenario/scenario.h"

namespace tcs {

class UdpOutlet final : public Outlet {
 public:
  static std::variant<std::unique_ptr<Outlet>, SocketError> Open(const UdpEndpoint& to);

  bool Send(const Reading& reading, VirtualTime arrives) override;
  VirtualTime NextDue() const override { return on_the_way_.NextDue(); }
  bool HandOver(VirtualTime now) override;
  std::string WhyUnheard() const override;

 private:
  UdpOutlet(UdpSocket socket, UdpEndpoint to) : socket_(std::move(socket)), to_(std::move(to)) {}

  UdpSocket socket_;
  UdpEndpoint to_;
  OnTheWay on_the_way_;
};

class UdpInlet final : public Inlet {
 public:
  static std::variant<std::unique_ptr<Inlet>, SocketError> Open(const UdpEndpoint& from,
                                                                std::size_t channel);

  int fd() const override { return socket_.fd(); }
  void Receive(VirtualTime now, CommandSink& sink) override;
  Place PlaceOf(std::size_t channel) const override;

 private:
  UdpInlet(UdpSocket socket, UdpEndpoint from, std::size_t channel)
      : socket_(std::move(socket)), from_(std::move(from)), channel_(channel) {}

  UdpSocket socket_;
  UdpEndpoint from_;
  std::size_t channel_;
};

}  // namespace tcs
