#include "coordinator/gateway/frames.h"

#include <errno.h>
#include <sys/socket.h>
#include <sys/uio.h>

namespace tcs::gateway {
namespace {

struct Header {
  std::uint64_t size;
  std::int64_t timestamp_ns;
  std::uint64_t end;
};

}  // namespace

bool Frames::Send(std::uint32_t end, std::int64_t timestamp_ns, std::span<const std::byte> cdr) {
  Header header{cdr.size(), timestamp_ns, end};
  iovec parts[] = {{&header, sizeof header}, {const_cast<std::byte*>(cdr.data()), cdr.size()}};
  msghdr message{};
  message.msg_iov = parts;
  message.msg_iovlen = 2;
  const std::lock_guard lock(mutex_);
  while (message.msg_iovlen > 0) {
    const ssize_t sent = sendmsg(fd_, &message, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) return false;
    auto left = static_cast<std::size_t>(sent);
    while (message.msg_iovlen > 0 && left >= message.msg_iov->iov_len) {
      left -= message.msg_iov->iov_len;
      ++message.msg_iov;
      --message.msg_iovlen;
    }
    if (message.msg_iovlen == 0) break;
    message.msg_iov->iov_base = static_cast<char*>(message.msg_iov->iov_base) + left;
    message.msg_iov->iov_len -= left;
  }
  return true;
}

bool Frames::ReadWhole(void* to, std::size_t size) const {
  while (size > 0) {
    const ssize_t received = recv(fd_, to, size, 0);
    if (received < 0 && errno == EINTR) continue;
    if (received <= 0) return false;
    to = static_cast<char*>(to) + received;
    size -= static_cast<std::size_t>(received);
  }
  return true;
}

std::optional<Frame> Frames::Receive() {
  Header header{};
  if (!ReadWhole(&header, sizeof header)) return std::nullopt;
  Frame frame{static_cast<std::uint32_t>(header.end), header.timestamp_ns, {}};
  frame.cdr.resize(header.size);
  if (!ReadWhole(frame.cdr.data(), frame.cdr.size())) return std::nullopt;
  return frame;
}

}  // namespace tcs::gateway
