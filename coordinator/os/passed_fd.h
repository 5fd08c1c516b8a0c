// Descriptors that processes send each other beside a message (SCM_RIGHTS), over a pair of
// SOCK_SEQPACKET sockets.
#pragma once

#include <sys/socket.h>
#include <sys/types.h>
#include <sys/uio.h>

#include <cstddef>
#include <optional>
#include <span>

#include "coordinator/port/unique_fd.h"
#include "shm/attach_protocol.h"

namespace tcs {

// Closed at exec.
struct SocketPair {
  UniqueFd ours, theirs;

  // None: errno is set.
  static std::optional<SocketPair> Make();
};

// A message for sendmsg, with descriptors beside it, kMostAttachFds at the most. `bytes` must live
// as long.
class PassedMessage {
 public:
  PassedMessage(void* bytes, std::size_t size, std::span<const int> fds);
  PassedMessage(const PassedMessage&) = delete;
  PassedMessage& operator=(const PassedMessage&) = delete;

  const msghdr* get() const { return &message_; }

 private:
  iovec iov_;
  alignas(cmsghdr) char control_[CMSG_SPACE(shm::kMostAttachFds * sizeof(int))] = {};
  msghdr message_{};
};

struct Passed {
  ssize_t size = -1;  // of the message; 0: the other end is closed; -1: errno is set
  UniqueFd fd;        // the first that came beside it, closed at exec
  pid_t sender = 0;   // as the kernel says, where the socket asks for it (SO_PASSCRED)
};
Passed ReceivePassed(int socket, void* to, std::size_t size, int flags);

}  // namespace tcs
