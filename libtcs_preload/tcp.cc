// TCP between programs, without the timers by which the kernel gathers bytes and acknowledgements:
// these timers run in the host's time, and a byte written at v is to be there at v.
//
//   * A socket sends small segments at once (TCP_NODELAY), and is never corked. The program is
//     still told what it has asked for.
//   * A reader acknowledges at once (tcp.h), so that a sender is not kept waiting.
//   * A listener's queue is as long as the host allows: where the queue is full the kernel drops
//     the beginning of a connection, and the other end tries again a second later.
#include "libtcs_preload/tcp.h"

#include <errno.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <string.h>
#include <sys/socket.h>

#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/linger.h"
#include "libtcs_preload/raw_syscall.h"

using namespace tcs::preload;

namespace {

// Where the program's wishes are kept: in flags of the socket itself that mean nothing to a stream.
// So the wishes go wherever the socket goes: to children, to other programs, and from a listener to
// the connections that it accepts.
constexpr int kAskedForNoDelay = SO_RXQ_OVFL, kAskedForCork = SO_NOFCS;

constexpr int kLongestQueue = 4096;

long Set(int fd, int level, int option, int value) {
  return RawSyscall(SYS_setsockopt, fd, level, option, Arg(&value), sizeof value);
}

int Get(int fd, int level, int option) {
  int value = 0;
  socklen_t size = sizeof value;
  RawSyscall(SYS_getsockopt, fd, level, option, Arg(&value), Arg(&size));
  return value;
}

bool IsInternet(int domain) { return domain == AF_INET || domain == AF_INET6; }

// The flag for a wish of this name; 0 for other options.
int WishFor(int level, int option) {
  if (level != IPPROTO_TCP) return 0;
  if (option == TCP_NODELAY) return kAskedForNoDelay;
  return option == TCP_CORK ? kAskedForCork : 0;
}

}  // namespace

namespace tcs::preload {

void SendAtOnce(int fd) { Set(fd, IPPROTO_TCP, TCP_NODELAY, 1); }

bool AcknowledgeAtOnce(int fd) { return Set(fd, IPPROTO_TCP, TCP_QUICKACK, 1) == 0; }

bool IsTcp(int fd) {
  const int protocol = Get(fd, SOL_SOCKET, SO_PROTOCOL);
  return protocol == IPPROTO_TCP || protocol == IPPROTO_MPTCP;
}

}  // namespace tcs::preload

// None of these calls is charged: they prepare what programs do.

TCS_EXPORT int socket(int domain, int type, int protocol) noexcept {
  const long fd = RawSyscall(SYS_socket, domain, type, protocol);
  constexpr int kTypeMask = 0xf;
  if (fd >= 0 && IsInternet(domain) && (type & kTypeMask) == SOCK_STREAM && Current() != nullptr) {
    SendAtOnce(static_cast<int>(fd));
  }
  return static_cast<int>(ToErrno(fd));
}

TCS_EXPORT int listen(int fd, int backlog) noexcept {
  if (Current() != nullptr && backlog < kLongestQueue &&
      IsInternet(Get(fd, SOL_SOCKET, SO_DOMAIN))) {
    backlog = kLongestQueue;
  }
  return static_cast<int>(ToErrno(RawSyscall(SYS_listen, fd, backlog)));
}

// The kernel judges the call; then it is made to forget the option.
TCS_EXPORT int setsockopt(int fd, int level, int option, const void* value,
                          socklen_t size) noexcept {
  const long result = RawSyscall(SYS_setsockopt, fd, level, option, Arg(value), size);
  if (result == 0 && level == IPPROTO_TCP && Current() != nullptr) {
    if (const int wish = WishFor(level, option); wish != 0) {
      int asked = 0;
      memcpy(&asked, value, sizeof asked);
      Set(fd, SOL_SOCKET, wish, asked != 0 ? 1 : 0);
      if (option == TCP_CORK) Set(fd, IPPROTO_TCP, TCP_CORK, 0);
      SendAtOnce(fd);
    }
    if (option == TCP_QUICKACK) AcknowledgeAtOnce(fd);
  }
  if (result == 0 && level == SOL_SOCKET && option == SO_LINGER) NoteLinger(value, size);
  return static_cast<int>(ToErrno(result));
}

TCS_EXPORT int getsockopt(int fd, int level, int option, void* value, socklen_t* size) noexcept {
  const long result = RawSyscall(SYS_getsockopt, fd, level, option, Arg(value), Arg(size));
  const int wish = result == 0 ? WishFor(level, option) : 0;
  if (wish != 0 && Current() != nullptr) {
    const int asked = Get(fd, SOL_SOCKET, wish);
    memcpy(value, &asked, *size < sizeof asked ? *size : sizeof asked);
  }
  return static_cast<int>(ToErrno(result));
}
