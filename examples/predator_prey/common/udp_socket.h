// A UDP socket on the loopback interface. Owns its descriptor. For one thread.
#pragma once

#include <netinet/in.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "examples/predator_prey/common/unique_fd.h"

namespace predator_prey {

class UdpSocket {
 public:
  // Receives on `port`. Throws std::system_error, which says which port, when it is taken.
  static UdpSocket BoundTo(std::uint16_t port);

  // Sends to `port`, and receives what is sent back from there.
  static UdpSocket ConnectedTo(std::uint16_t port);

  int fd() const { return fd_.get(); }

  enum class Status { kDatagram, kNothing, kPeerAbsent };

  // The next datagram, without waiting for one. kPeerAbsent: what was sent on this connected socket
  // found nobody listening.
  Status Receive(std::string& datagram);

  // The newest datagram that is here; older ones are dropped.
  std::optional<std::string> ReceiveNewest();

  // To the connected peer, or to the sender of the datagram received last. Like any datagram it may
  // be lost: a peer that is not there (yet) is no error. Throws std::system_error otherwise.
  void Send(std::string_view datagram);

 private:
  explicit UdpSocket(UniqueFd fd) : fd_(std::move(fd)) {}

  UniqueFd fd_;
  bool connected_ = false;
  sockaddr_in last_sender_{};
};

}  // namespace predator_prey
