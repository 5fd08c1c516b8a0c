// Reading and writing descriptors that can make a program wait: sockets, pipes, terminals.
//
// Kernel-carried data is there at once for anybody who looks. So a write waits until nobody can
// look at an earlier virtual time, and a read until nobody can write at an earlier one.
#include <errno.h>
#include <stdarg.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/fd_wait.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/virtual_clock.h"

using namespace tcs::preload;

namespace {

template <class Call>
ssize_t ReadLike(int fd, bool dont_wait, bool socket, Call call) {
  GuestThread* t = Enter();
  if (t == nullptr || !CanWait(fd)) return ToErrno(call());
  FdState state = FdState::kReady;
  if (!dont_wait) {
    const std::int64_t deadline = socket ? SocketDeadline(*t, fd, SO_RCVTIMEO) : tcs::shm::kNeverNs;
    state = AwaitFd(*t, fd, POLLIN, deadline);
  }
  if (state == FdState::kFailed) return -1;
  if (state == FdState::kReady) HoldForReadFrom(*t, fd, socket);
  return ToErrno(call());
}

template <class Call>
ssize_t WriteLike(int fd, bool dont_wait, bool socket, Call call) {
  GuestThread* t = Enter();
  if (t == nullptr || !CanWait(fd)) return ToErrno(call());
  HoldForWrite(*t);
  if (!dont_wait) {
    const std::int64_t deadline = socket ? SocketDeadline(*t, fd, SO_SNDTIMEO) : tcs::shm::kNeverNs;
    if (AwaitFd(*t, fd, POLLOUT, deadline) == FdState::kFailed) return -1;
  }
  return ToErrno(call());
}

bool DontWait(int flags) { return (flags & MSG_DONTWAIT) != 0; }

}  // namespace

TCS_EXPORT ssize_t read(int fd, void* buffer, std::size_t size) {
  return ReadLike(fd, false, false, [&] { return RawSyscall(SYS_read, fd, Arg(buffer), size); });
}

TCS_EXPORT ssize_t __read_chk(int fd, void* buffer, std::size_t size, std::size_t room) {
  if (size > room) __builtin_trap();
  return read(fd, buffer, size);
}

TCS_EXPORT ssize_t readv(int fd, const iovec* iov, int count) {
  return ReadLike(fd, false, false, [&] { return RawSyscall(SYS_readv, fd, Arg(iov), count); });
}

TCS_EXPORT ssize_t recvfrom(int fd, void* buffer, std::size_t size, int flags, sockaddr* from,
                            socklen_t* from_size) {
  return ReadLike(fd, DontWait(flags), true, [&] {
    return RawSyscall(SYS_recvfrom, fd, Arg(buffer), size, flags, Arg(from), Arg(from_size));
  });
}

TCS_EXPORT ssize_t __recvfrom_chk(int fd, void* buffer, std::size_t size, std::size_t room,
                                  int flags, sockaddr* from, socklen_t* from_size) {
  if (size > room) __builtin_trap();
  return recvfrom(fd, buffer, size, flags, from, from_size);
}

TCS_EXPORT ssize_t recv(int fd, void* buffer, std::size_t size, int flags) {
  return recvfrom(fd, buffer, size, flags, nullptr, nullptr);
}

TCS_EXPORT ssize_t __recv_chk(int fd, void* buffer, std::size_t size, std::size_t room, int flags) {
  if (size > room) __builtin_trap();
  return recv(fd, buffer, size, flags);
}

TCS_EXPORT ssize_t recvmsg(int fd, msghdr* message, int flags) {
  return ReadLike(fd, DontWait(flags), true,
                  [&] { return RawSyscall(SYS_recvmsg, fd, Arg(message), flags); });
}

// One message is waited for; those that are there with it come along. A timeout is a virtual one.
TCS_EXPORT int recvmmsg(int fd, mmsghdr* messages, unsigned count, int flags, timespec* timeout) {
  GuestThread* t = Enter();
  if (t == nullptr) {
    return static_cast<int>(
        ToErrno(RawSyscall(SYS_recvmmsg, fd, Arg(messages), count, flags, Arg(timeout))));
  }
  FdState state = FdState::kReady;
  if (!DontWait(flags)) {
    std::int64_t deadline = SocketDeadline(*t, fd, SO_RCVTIMEO);
    if (timeout != nullptr) deadline = DeadlineAfter(*t, ToNs(*timeout));
    state = AwaitFd(*t, fd, POLLIN, deadline);
  }
  if (state == FdState::kFailed) return -1;
  // All that are there come along, so all that are from before must be there.
  if (state == FdState::kReady) HoldForRead(*t);
  return static_cast<int>(
      ToErrno(RawSyscall(SYS_recvmmsg, fd, Arg(messages), count, flags | MSG_DONTWAIT, 0)));
}

TCS_EXPORT int accept4(int fd, sockaddr* address, socklen_t* size, int flags) {
  return static_cast<int>(ReadLike(fd, false, true, [&] {
    return RawSyscall(SYS_accept4, fd, Arg(address), Arg(size), flags);
  }));
}

TCS_EXPORT int accept(int fd, sockaddr* address, socklen_t* size) {
  return accept4(fd, address, size, 0);
}

TCS_EXPORT ssize_t write(int fd, const void* buffer, std::size_t size) {
  return WriteLike(fd, false, false, [&] { return RawSyscall(SYS_write, fd, Arg(buffer), size); });
}

TCS_EXPORT ssize_t writev(int fd, const iovec* iov, int count) {
  return WriteLike(fd, false, false, [&] { return RawSyscall(SYS_writev, fd, Arg(iov), count); });
}

TCS_EXPORT ssize_t sendto(int fd, const void* buffer, std::size_t size, int flags,
                          const sockaddr* to, socklen_t to_size) {
  return WriteLike(fd, DontWait(flags), true, [&] {
    return RawSyscall(SYS_sendto, fd, Arg(buffer), size, flags, Arg(to), to_size);
  });
}

TCS_EXPORT ssize_t send(int fd, const void* buffer, std::size_t size, int flags) {
  return sendto(fd, buffer, size, flags, nullptr, 0);
}

TCS_EXPORT ssize_t sendmsg(int fd, const msghdr* message, int flags) {
  return WriteLike(fd, DontWait(flags), true,
                   [&] { return RawSyscall(SYS_sendmsg, fd, Arg(message), flags); });
}

TCS_EXPORT int sendmmsg(int fd, mmsghdr* messages, unsigned count, int flags) {
  return static_cast<int>(WriteLike(fd, DontWait(flags), true, [&] {
    return RawSyscall(SYS_sendmmsg, fd, Arg(messages), count, flags);
  }));
}

// Connecting is a write: it makes the listener's descriptor readable.
TCS_EXPORT int connect(int fd, const sockaddr* address, socklen_t size) {
  GuestThread* t = Enter();
  if (t != nullptr) HoldForWrite(*t);
  return static_cast<int>(ToErrno(RawSyscall(SYS_connect, fd, Arg(address), size)));
}
