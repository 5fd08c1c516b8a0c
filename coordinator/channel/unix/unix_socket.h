// A non-blocking UNIX datagram socket, and the file that it has.
//
// Owns its descriptor, which is close-on-exec, and the file: the file is removed with the socket,
// and by the keeper if this process is killed (os/guardian.h). Movable. Used by one thread at a
// time. Failures that a user can mend come back as sentences.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "coordinator/port/unique_fd.h"
#include "coordinator/scenario/scenario.h"
#include "shm/own_receivers.h"

namespace tcs {

class UnixSocket {
 public:
  // A socket that receives what is sent to `name`. The file of a socket that no program has open
  // any more is replaced.
  [[nodiscard]] static std::variant<UnixSocket, std::string> Bind(const UnixName& name);
  // A socket for sending only; it has no name.
  [[nodiscard]] static std::variant<UnixSocket, std::string> ForSending();

  UnixSocket(UnixSocket&& other) noexcept
      : fd_(std::move(other.fd_)), file_(std::exchange(other.file_, {})) {}
  UnixSocket& operator=(UnixSocket&&) = delete;
  ~UnixSocket();

  // The descriptor, for epoll; it stays the socket's.
  int fd() const { return fd_.get(); }

  // Sends one datagram without waiting. False if no program has bound the name, or it has no room:
  // errno says which.
  [[nodiscard]] bool SendTo(const UnixName& to, std::string_view payload);

  // All datagrams that have come, in order. Whole up to kLongest bytes: more than a program may
  // send at once, unless it has the right to larger buffers than the host allows.
  static constexpr std::size_t kLongest = 1 << 20;
  [[nodiscard]] std::vector<std::string> ReceiveAll();

 private:
  explicit UnixSocket(UniqueFd fd) : fd_(std::move(fd)) {}

  UniqueFd fd_;
  std::string file_;  // the file's path; empty: there is no file
};

// Whether some socket gets what is sent to `name`.
[[nodiscard]] bool IsListenedTo(const UnixName& name);

// The address of the name as the kernel has it.
shm::ReceiverAddress KernelAddressOf(const UnixName& name);

}  // namespace tcs
