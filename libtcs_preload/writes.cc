// Writing descriptors that can make a program wait, and connecting them.
//
// Kernel-carried data is there at once for any thread that looks. So a write waits until no thread
// can look at an earlier virtual time.
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>
#include <x86gprintrin.h>

#include "libtcs_preload/call_file.h"
#include "libtcs_preload/datagram_notes.h"
#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/fd_wait.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/kernel_objects.h"
#include "libtcs_preload/local_sockets.h"
#include "libtcs_preload/outside.h"
#include "libtcs_preload/own_receivers.h"
#include "libtcs_preload/own_work.h"
#include "libtcs_preload/pieces.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/signal_actions.h"
#include "libtcs_preload/tcp.h"
#include "libtcs_preload/terminals.h"
#include "libtcs_preload/transfer.h"
#include "libtcs_preload/user_memory.h"
#include "libtcs_preload/virtual_clock.h"

using namespace tcs::preload;

namespace {

// A UNIX stream connects once its listener has room. That room cannot be polled; threads that
// accept say that there is room again.
constexpr auto kBacklogs = tcs::shm::KernelObjectKind::kBacklogs;

// TCP would keep data for which MSG_MORE announces more until a timer of the host's runs out.
int WithoutMore(int fd, int flags) {
  return (flags & MSG_MORE) != 0 && IsTcp(fd) ? flags & ~MSG_MORE : flags;
}

bool DontWait(int flags) { return (flags & MSG_DONTWAIT) != 0; }

long WritePart(int fd, const iovec* iov, std::size_t count) {
  return RawSyscall(SYS_pwritev2, fd, Arg(iov), static_cast<long>(count), -1, -1, RWF_NOWAIT);
}

// False for buffers that the kernel would not find there, or not look at: the kernel is left to say
// so.
bool AreSound(const iovec* buffers, std::size_t count) {
  if (count > kMostBuffers || !CanRead(buffers, count * sizeof *buffers)) return false;
  for (std::size_t i = 0; i < count; ++i) {
    if (static_cast<ssize_t>(buffers[i].iov_len) < 0) return false;
  }
  return true;
}

template <class Whole>
ssize_t WriteAll(int fd, const iovec* iov, std::size_t count, Whole whole) {
  const Entered t;
  pthread_testcancel();
  if (t == nullptr) return ToErrno(whole(fd));
  const OwnWork own(t);
  const auto at_once = [&] { return AsProgram(*t, [&] { return whole(fd); }); };
  if (!CanWait(fd)) return ToErrno(at_once());
  HoldForWrite(*t);
  Rest rest(iov, AreSound(iov, count) ? count : 0);
  if (NotesActivity()) NoteDatagram(*t, fd, nullptr, 0);
  const OutsideAsk ask = BeginAsk(fd);
  const long result = rest.bytes() == 0 ? at_once()
                                        : TransferAll(*t, fd, POLLOUT, SO_SNDTIMEO, rest,
                                                      g_header->write_form_ticks, WritePart, whole);
  if (result < 0 && NotesActivity()) TakeBackDatagram(*t, fd, nullptr, 0);
  if (result > 0 && AnybodyWaits() && IsTerminal(fd)) {
    TellChanged(*t, tcs::shm::KernelObjectKind::kTerminals, 0);
  }
  if (result > 0) NoteAsks(*t, fd, ask);
  return ToErrno(result);
}

// A message that only the coordinator receives waits for nobody: the coordinator keeps it until its
// virtual time. Returns the coordinator's receiver of the message.
int HoldToSend(GuestThread& t, int fd, const msghdr& message) {
  const bool may_go_on = BeginWrite(t);
  const bool reaches_safely = ReachesSafely(t, message);
  const int receiver = ReceiverOf(fd, message.msg_name, message.msg_namelen);
  if (!reaches_safely && !may_go_on && receiver == tcs::shm::kNoReceiver) {
    HoldForWrite(t);
  }
  return receiver;
}

// Control data travels with the first part.
template <class Whole>
ssize_t SendInParts(GuestThread* t, int fd, msghdr message, int flags, Whole whole) {
  if (message.msg_iovlen > kMostBuffers || DontWait(flags)) {
    return ToErrno(AsProgram(*t, [&] { return whole(fd); }));
  }
  Rest rest(message.msg_iov, message.msg_iovlen);
  return ToErrno(TransferAll(
      *t, fd, POLLOUT, SO_SNDTIMEO, rest, 0,
      [&](int to, const iovec* part, std::size_t n) {
        message.msg_iov = const_cast<iovec*>(part);
        message.msg_iovlen = n;
        const long sent = RawSyscall(SYS_sendmsg, to, Arg(&message), flags | MSG_DONTWAIT);
        if (sent > 0) message.msg_controllen = 0;
        return sent;
      },
      whole));
}

// `may_post`: false once the kernel has carried a message of this call. That message is read before
// any that is posted later in the call only where the coordinator wakes at once, which gates alone
// do not see to.
template <class Whole>
ssize_t SendAll(GuestThread* t, int fd, const msghdr& message, int flags, bool* may_post,
                Whole whole) {
  if (t == nullptr) return ToErrno(whole(fd));
  const OwnWork own(t);
  const bool was_in_call = t->in_call;
  const int receiver = HoldToSend(*t, fd, message);
  if (NotesActivity()) NoteDatagram(*t, fd, message.msg_name, message.msg_namelen);
  const OutsideAsk ask = BeginAsk(fd);
  long posted = 0;
  ssize_t sent;
  // What posts is the program's call: no other is made for it.
  const auto post = [&] { return Post(*t, fd, receiver, message, flags, &posted) ? 1 : 0; };
  if (*may_post && AsProgram(*t, post) != 0) {
    t->in_call = was_in_call;  // nobody has seen the message yet
    sent = ToErrno(posted);
  } else {
    *may_post = false;
    // The coordinator would take the message for something that happens when it finds the message.
    if (receiver != tcs::shm::kNoReceiver && IsBeside(*t)) {
      Exchange(*t, Request{.kind = tcs::shm::NotificationKind::kWrite});
    }
    sent = SendInParts(t, fd, message, flags, whole);
  }
  if (sent < 0 && NotesActivity()) {
    const int error = errno;
    TakeBackDatagram(*t, fd, message.msg_name, message.msg_namelen);
    errno = error;
  }
  if (sent >= 0 && posted == 0) NoteAsks(*t, fd, ask);
  return sent;
}

}  // namespace

TCS_EXPORT ssize_t write(int fd, const void* buffer, std::size_t size) {
  const iovec iov{const_cast<void*>(buffer), size};
  const std::size_t pieces = IsBeyondMemory(buffer, size) ? 0 : 1;  // to be moved in parts
  return WriteAll(fd, &iov, pieces,
                  [&](int to) { return RawSyscall(SYS_write, to, Arg(buffer), size); });
}

TCS_EXPORT ssize_t writev(int fd, const iovec* iov, int count) {
  return WriteAll(fd, iov, static_cast<std::size_t>(count),
                  [&](int to) { return RawSyscall(SYS_writev, to, Arg(iov), count); });
}

TCS_EXPORT ssize_t sendto(int fd, const void* buffer, std::size_t size, int flags,
                          const sockaddr* to, socklen_t to_size) {
  iovec iov = PieceOf(buffer, size);
  msghdr message{};
  message.msg_name = const_cast<sockaddr*>(to);
  message.msg_namelen = to_size;
  message.msg_iov = &iov;
  message.msg_iovlen = 1;
  const Entered t;
  if (t != nullptr) flags = WithoutMore(fd, flags);
  bool may_post = true;
  return SendAll(t, fd, message, flags, &may_post, [&](int by) {
    return RawSocketCall(SYS_sendto, by, Arg(buffer), size, flags, Arg(to), to_size);
  });
}

TCS_EXPORT ssize_t send(int fd, const void* buffer, std::size_t size, int flags) {
  return sendto(fd, buffer, size, flags, nullptr, 0);
}

TCS_EXPORT ssize_t sendmsg(int fd, const msghdr* message, int flags) {
  msghdr copy{};
  const Entered t(CopyIn(&copy, message));
  if (t != nullptr) flags = WithoutMore(fd, flags);
  bool may_post = true;
  return SendAll(t, fd, copy, flags, &may_post,
                 [&](int by) { return RawSyscall(SYS_sendmsg, by, Arg(message), flags); });
}

// The call waits where the socket has no room, until all messages have been sent.
TCS_EXPORT int sendmmsg(int fd, mmsghdr* messages, unsigned count, int flags) {
  const Entered t;
  if (t != nullptr) flags = WithoutMore(fd, flags);
  if (count == 0) return static_cast<int>(ToErrno(RawSyscall(SYS_sendmmsg, fd, 0, 0, flags)));
  if (count > kMostBuffers) count = kMostBuffers;
  bool may_post = true;
  for (unsigned sent = 0; sent < count; ++sent) {
    msghdr* message = &messages[sent].msg_hdr;
    msghdr copy{};
    const ssize_t n =
        SendAll(CopyIn(&copy, message) ? t.thread() : nullptr, fd, copy, flags, &may_post,
                [&](int by) { return RawSyscall(SYS_sendmsg, by, Arg(message), flags); });
    const bool done = n >= 0 && CopyOut(&messages[sent].msg_len, static_cast<unsigned>(n));
    if (n >= 0 && !done) errno = EFAULT;
    if (!done) return sent > 0 ? static_cast<int>(sent) : -1;
  }
  return static_cast<int>(count);
}

namespace {

long ConnectOnce(int fd, const sockaddr* address, socklen_t size) {
  const long flags = RawSyscall(SYS_fcntl, fd, F_GETFL);
  RawSyscall(SYS_fcntl, fd, F_SETFL, flags | O_NONBLOCK);
  const long result = RawSyscall(SYS_connect, fd, Arg(address), size);
  RawSyscall(SYS_fcntl, fd, F_SETFL, flags);
  return result;
}

long ConnectLocally(GuestThread& t, int fd, const sockaddr* address, socklen_t size) {
  const std::int64_t deadline = SocketDeadline(t, fd, SO_SNDTIMEO);
  CallFile file(t, fd);
  for (bool again = false;; again = true) {
    const long result = ConnectOnce(file.fd(), address, size);
    if (result != -EAGAIN || IsShutDown()) return result;
    switch (file.WaitForObject(kBacklogs, deadline, again)) {
      case WaitResult::kRetry:
        break;
      case WaitResult::kTimedOut:
        return ConnectOnce(file.fd(), address, size);
      case WaitResult::kInterrupted:
        if (!RestartsAfterSignal()) return -EINTR;
        break;
    }
  }
}

// The other end may be a while away.
long ConnectFar(GuestThread& t, int fd, const sockaddr* address, socklen_t size) {
  const std::uint64_t begun_tsc = __rdtsc();
  const long result = ConnectOnce(fd, address, size);
  if (result != -EINPROGRESS) return result;
  NoteConnects(t, fd, begun_tsc, true);
  CallFile file(t, fd);
  const int saved = errno;
  const std::int64_t deadline = SocketDeadline(t, fd, SO_SNDTIMEO);
  FdState state = FdState::kReady;
  for (bool again = false;; again = true) {
    const bool is_hidden = HiddenOf(t, OutsideOf(file.fd())) == Hides::kAll;
    if (!is_hidden && PollNow(file.fd(), POLLOUT)) break;
    if (state == FdState::kTimedOut) return -EINPROGRESS;
    state = AwaitEvent(file, POLLOUT, deadline, again);
    if (state != FdState::kFailed) continue;
    const int error = errno;
    errno = saved;
    return -error;
  }
  // By this the kernel, too, finds that the socket is connected, or not, and says what became of
  // it.
  return ConnectOnce(file.fd(), address, size);
}

}  // namespace

// Connecting is a write: it makes the listener's descriptor readable.
TCS_EXPORT int connect(int fd, const sockaddr* address, socklen_t size) {
  const Entered t;
  if (t != nullptr) {
    const bool may_go_on = BeginWrite(*t);
    if (!ReachesSafely(*t, address, size) && !may_go_on) HoldForWrite(*t);
  }
  sa_family_t family = AF_UNSPEC;
  if (t != nullptr && size >= sizeof family && CanRead(address, sizeof family)) {
    family = address->sa_family;
  }
  const bool is_internet = family == AF_INET || family == AF_INET6;
  const std::uint64_t begun_tsc = __rdtsc();
  long result = 0;
  if (family == AF_UNIX && !IsNonBlocking(fd)) {
    result = ConnectLocally(*t, fd, address, size);
  } else if (is_internet && !IsNonBlocking(fd)) {
    result = ConnectFar(*t, fd, address, size);
  } else {
    result = RawSyscall(SYS_connect, fd, Arg(address), size);
  }
  if ((is_internet || family == AF_UNIX) && (result == 0 || result == -EINPROGRESS)) {
    NoteConnects(*t, fd, begun_tsc, result == -EINPROGRESS);
  }
  return static_cast<int>(ToErrno(result));
}
