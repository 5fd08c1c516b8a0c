// A UDP socket of this computer. Owns its descriptor. For one thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "examples/predator_prey/prey_controller/unique_fd.h"

namespace predator_prey {

class UdpSocket {
 public:
  // Receives on `port` of `address`, IPv4 in numbers. Throws std::system_error, which says which
  // port, when it is taken.
  static UdpSocket BoundTo(const std::string& address, std::uint16_t port);

  // Sends to `port` of `address`.
  static UdpSocket ConnectedTo(const std::string& address, std::uint16_t port);

  int fd() const { return fd_.get(); }

  // The newest datagram that is here; older ones are dropped.
  std::optional<std::string> ReceiveNewest();

  // To the connected peer. Like any datagram it may be lost: a peer that is not there (yet) is no
  // error. Throws std::system_error otherwise.
  void Send(std::string_view datagram);

 private:
  explicit UdpSocket(UniqueFd fd) : fd_(std::move(fd)) {}

  UniqueFd fd_;
};

}  // namespace predator_prey
