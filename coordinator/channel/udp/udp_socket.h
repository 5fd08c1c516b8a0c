// A non-blocking IPv4 UDP socket.
//
// Owns its descriptor, which is close-on-exec; movable. Used by one thread at a time. Failures that
// a user can mend come back as sentences.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "coordinator/port/unique_fd.h"
#include "coordinator/scenario/scenario.h"
#include "shm/own_receivers.h"

namespace tcs {

struct SocketError {
  std::string message;  // one sentence
  int error_number = 0;
};

struct Datagram {
  std::string payload;
  UdpEndpoint from;
};

class UdpSocket {
 public:
  // A socket that receives what is sent to `endpoint`; port 0 lets the kernel choose.
  [[nodiscard]] static std::variant<UdpSocket, SocketError> Bind(const UdpEndpoint& endpoint);
  // A socket for sending only; its port is the kernel's choice.
  [[nodiscard]] static std::variant<UdpSocket, SocketError> ForSending();

  // The descriptor, for epoll; it stays the socket's.
  int fd() const { return fd_.get(); }
  // The address it is bound to; port 0 before the first send of a socket for sending.
  UdpEndpoint LocalEndpoint() const;

  // Sends one datagram without waiting. UDP promises nothing: success means that the kernel took
  // it. A full send buffer is an error (EAGAIN).
  [[nodiscard]] std::optional<SocketError> SendTo(const UdpEndpoint& to, std::string_view payload);

  // The next datagram, whole; none if nothing has come.
  [[nodiscard]] std::variant<std::optional<Datagram>, SocketError> Receive();

 private:
  explicit UdpSocket(UniqueFd fd) : fd_(std::move(fd)) {}

  UniqueFd fd_;
};

// Whether some socket of this machine gets what is sent to `endpoint`; true where that is not for
// this machine to know.
[[nodiscard]] bool IsListenedTo(const UdpEndpoint& endpoint);

// The endpoint's address as the kernel has it.
shm::ReceiverAddress KernelAddressOf(const UdpEndpoint& endpoint);

}  // namespace tcs
