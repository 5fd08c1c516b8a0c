#include "libtcs_preload/non_blocking.h"

#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>

#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/timer_fds.h"

namespace tcs::preload {

namespace {

int SocketOption(int fd, int option, int otherwise) {
  int value = 0;
  socklen_t size = sizeof value;
  return RawSyscall(SYS_getsockopt, fd, SOL_SOCKET, option, Arg(&value), Arg(&size)) == 0
             ? value
             : otherwise;
}

std::size_t BytesOf(const iovec* iov, int count) {
  std::size_t bytes = 0;
  for (int i = 0; i < count; ++i) bytes += iov[i].iov_len;
  return bytes;
}

}  // namespace

long TryRead(int fd, const iovec* iov, int count) {
  return RawSyscall(SYS_preadv2, fd, Arg(iov), count, -1, -1, RWF_NOWAIT);
}

long TryReadWithoutForm(int fd, const iovec* iov, int count) {
  return IsTimerFd(fd) && BytesOf(iov, count) < sizeof(std::uint64_t) ? -EINVAL : -EAGAIN;
}

bool AcceptWaits(int fd, int flags) {
  return (flags & ~(SOCK_CLOEXEC | SOCK_NONBLOCK)) == 0 && SocketOption(fd, SO_ACCEPTCONN, 0) != 0;
}

bool WantsMore(int fd) { return SocketOption(fd, SO_RCVLOWAT, 1) > 1; }

bool ReadingMakesRoom(int fd) { return SocketOption(fd, SO_PROTOCOL, 0) != IPPROTO_UDP; }

bool ReceivesAtOnce(int fd, int flags) {
  if ((flags & MSG_DONTWAIT) != 0) return true;
  // The errors of a socket are there or not; but UNIX sockets have none, and overlook the flag.
  return (flags & MSG_ERRQUEUE) != 0 && SocketOption(fd, SO_DOMAIN, AF_UNIX) != AF_UNIX;
}

}  // namespace tcs::preload
