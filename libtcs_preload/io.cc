// Reading and writing descriptors that can make a program wait: sockets, pipes, terminals.
//
// Kernel-carried data is there at once for anybody who looks. So a write waits until nobody can
// look at an earlier virtual time, and a read until nobody can write at an earlier one.
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdarg.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include "libtcs_preload/at_once.h"
#include "libtcs_preload/datagram_notes.h"
#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/fd_wait.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/keys.h"
#include "libtcs_preload/local_sockets.h"
#include "libtcs_preload/own_receivers.h"
#include "libtcs_preload/random.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/receipts.h"
#include "libtcs_preload/signal_actions.h"
#include "libtcs_preload/stamps.h"
#include "libtcs_preload/tcp.h"
#include "libtcs_preload/terminals.h"
#include "libtcs_preload/transfer.h"
#include "libtcs_preload/user_memory.h"
#include "libtcs_preload/virtual_clock.h"

using namespace tcs::preload;

namespace {

constexpr std::size_t kMostBuffers = 1024;  // above it the kernel says EINVAL

// The kernel moves no more than this in a call (MAX_RW_COUNT). Of a buffer by itself it takes no
// notice of what is beyond, where in a list (sendmsg) it would say EINVAL.
constexpr std::size_t kMostBytes = 0x7fff'f000;
iovec PieceOf(const void* buffer, std::size_t size) {
  return {const_cast<void*>(buffer), size < kMostBytes ? size : kMostBytes};
}

// But read and write fail at once where not all of the buffer could be the program's.
bool IsBeyondMemory(const void* buffer, std::size_t size) {
  constexpr std::uintptr_t kEnd = std::uintptr_t{1} << 47;
  const auto begin = reinterpret_cast<std::uintptr_t>(buffer);
  return begin > kEnd || size > kEnd - begin;
}

using tcs::shm::kNeverNs;

// A UNIX stream connects once its listener has room. That cannot be polled; those who accept say
// that there is room again.
constexpr auto kBacklogs = tcs::shm::WaitKey::kBacklogs;

// TCP would keep what MSG_MORE announces more for until a timer of the host's runs out.
int WithoutMore(int fd, int flags) {
  return (flags & MSG_MORE) != 0 && IsTcp(fd) ? flags & ~MSG_MORE : flags;
}

bool DontWait(int flags) { return (flags & MSG_DONTWAIT) != 0; }

// Whether what a call with these flags receives is not there any more.
bool Takes(int flags) { return (flags & (MSG_PEEK | MSG_ERRQUEUE)) == 0; }

// Who waits to write may find room after a read. Asked only where that has the thread wait for its
// next call (CountCall).
void BeginTaking(GuestThread& t, int fd, bool socket) {
  if (socket && g_header->gates_only != 0 && !ReadingMakesRoom(fd)) return;
  BeginChange(t);
}

struct Reads {
  bool dont_wait = false, socket = false, takes = true;
  bool may_be_datagram = false;
};

// A terminal that is set to give up at the deadline, and then reads nothing.
template <class Take>
ssize_t ReadTerminal(GuestThread& t, int fd, std::int64_t deadline, Take take) {
  if (AwaitFd(t, fd, POLLIN, deadline) == FdState::kFailed) return errno == EAGAIN ? 0 : -1;
  const ssize_t result = take();
  const int error = errno;
  PassOn(t);
  errno = error;
  return result;
}

// Of a datagram socket: what is there is taken at once, for nothing that still comes is before it;
// and where nothing is there, and the call does not wait, that is so once nothing can come any
// more. False where the call has to wait, or it is another kind of descriptor.
template <class AtOnce>
bool ReadDatagram(GuestThread& t, int fd, Reads reads, AtOnce at_once, ssize_t* result) {
  int type = 0;
  socklen_t size = sizeof type;
  if (RawSyscall(SYS_getsockopt, fd, SOL_SOCKET, SO_TYPE, Arg(&type), Arg(&size)) != 0 ||
      type != SOCK_DGRAM) {
    return false;
  }
  const std::int64_t now = NowNs(t);
  BeginTaking(t, fd, true);
  long got = at_once();
  if (got == -EAGAIN) {
    if (!reads.dont_wait && !IsNonBlocking(fd)) return false;
    if (!IsSafeLook(t, fd, now)) {
      HoldForRead(t);
      BeginTaking(t, fd, true);
      got = at_once();
    }
  }
  if (got > 0 && reads.takes) NoteReceived(t);
  if (got >= 0 && reads.takes && NotesActivity()) NoteDatagramsReceived(t, fd, 1, true);
  *result = ToErrno(got);
  if (t.passes_on && !reads.dont_wait && !IsNonBlocking(fd)) {
    const int error = errno;
    PassOn(t);
    errno = error;
  }
  return true;
}

// `at_once` returns what the kernel answers without waiting, or -EAGAIN.
template <class AtOnce, class Call>
ssize_t ReadLike(int fd, Reads reads, AtOnce at_once, Call call) {
  const Entered t;
  pthread_testcancel();
  ssize_t got = 0;
  if (t != nullptr && reads.may_be_datagram && ReadDatagram(*t, fd, reads, at_once, &got)) {
    return got;
  }
  bool any_socket = false;
  if (t == nullptr || !CanWait(fd, &any_socket)) return ToErrno(call());
  auto take = [&] {
    if (any_socket) AcknowledgeAtOnce(fd);
    BeginTaking(*t, fd, any_socket);
    const long result = call();
    if (result > 0 && reads.takes) {
      if (any_socket) {
        NoteReceived(*t);
      } else {
        NoteReceivedFrom(*t, fd);
      }
    }
    if (any_socket && result >= 0 && reads.takes && NotesActivity()) {
      NoteDatagramsReceived(*t, fd, 1);
    }
    return ToErrno(result);
  };
  if (reads.dont_wait || IsNonBlocking(fd)) {
    HoldForReadFrom(*t, fd, reads.socket);
    return take();
  }
  bool ready = PollNow(fd, POLLIN);
  std::int64_t deadline = kNeverNs;
  if (!ready) {
    if (!any_socket || !WantsMore(fd)) {
      if (const long answer = at_once(); answer != -EAGAIN) return ToErrno(answer);
    }
    if (reads.socket) deadline = SocketDeadline(*t, fd, SO_RCVTIMEO);
    const std::int64_t timeout = any_socket ? kNeverNs : ReadTimeoutOf(fd);
    if (timeout == 0) {
      HoldForRead(*t);
      return take();
    }
    if (timeout != kNeverNs) return ReadTerminal(*t, fd, DeadlineAfter(*t, timeout), take);
  }
  for (bool looked = !ready;; ready = looked = false) {
    const FdState state = ready ? FdState::kReady : AwaitFd(*t, fd, POLLIN, deadline, looked);
    if (state == FdState::kFailed) return -1;
    // While it holds, somebody else may take what is there.
    if (state == FdState::kWaited || !HoldForReadFrom(*t, fd, reads.socket) ||
        PollNow(fd, POLLIN)) {
      const ssize_t result = take();
      const int error = errno;
      PassOn(*t);
      errno = error;
      return result;
    }
  }
}

long WritePart(int fd, const iovec* iov, std::size_t count) {
  return RawSyscall(SYS_pwritev2, fd, Arg(iov), static_cast<long>(count), -1, -1, RWF_NOWAIT);
}

// What the kernel would not find there, or not look at, is left for it to say.
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
  if (t == nullptr || !CanWait(fd)) return ToErrno(whole());
  HoldForWrite(*t);
  const bool at_once = !AreSound(iov, count) || IsNonBlocking(fd);
  Rest rest(iov, at_once ? 0 : count);
  if (NotesActivity()) NoteDatagram(*t, fd, nullptr, 0);
  const long result =
      rest.bytes() == 0
          ? whole()
          : TransferAll(
                *t, fd, POLLOUT, SO_SNDTIMEO, rest,
                [fd](const iovec* part, std::size_t n) { return WritePart(fd, part, n); }, whole);
  if (result < 0 && NotesActivity()) TakeBackDatagram(*t, fd, nullptr, 0);
  if (result > 0 && AnybodyWaits() && IsTerminal(fd)) {
    TellChanged(*t, tcs::shm::WaitKey::kTerminals, 0);
  }
  return ToErrno(result);
}

// What only the coordinator receives waits for nobody: it keeps it until its virtual time. Returns
// where it receives that.
int HoldToSend(GuestThread& t, int fd, const msghdr& message) {
  const bool may_go_on = BeginWrite(t);
  const bool reaches_safely = ReachesSafely(t, message);
  const int receiver = ReceiverOf(fd, message.msg_name, message.msg_namelen);
  if (!reaches_safely && !may_go_on && receiver == tcs::shm::kNoReceiver) {
    Exchange(t, Request{.kind = tcs::shm::NotificationKind::kWrite});
  }
  return receiver;
}

// Control data travels with the first part.
template <class Whole>
ssize_t SendInParts(GuestThread* t, int fd, msghdr message, int flags, Whole whole) {
  if (message.msg_iovlen > kMostBuffers || DontWait(flags) || IsNonBlocking(fd)) {
    return ToErrno(whole());
  }
  Rest rest(message.msg_iov, message.msg_iovlen);
  return ToErrno(TransferAll(
      *t, fd, POLLOUT, SO_SNDTIMEO, rest,
      [&](const iovec* part, std::size_t n) {
        message.msg_iov = const_cast<iovec*>(part);
        message.msg_iovlen = n;
        const long sent = RawSyscall(SYS_sendmsg, fd, Arg(&message), flags | MSG_DONTWAIT);
        if (sent > 0) message.msg_controllen = 0;
        return sent;
      },
      whole));
}

// `may_post`: false once the kernel has carried a message of this call. It is read before any that
// is posted later in the call only where the coordinator wakes at once, which gates alone do not
// see to.
template <class Whole>
ssize_t SendAll(GuestThread* t, int fd, const msghdr& message, int flags, bool* may_post,
                Whole whole) {
  if (t == nullptr) return ToErrno(whole());
  const bool was_in_call = t->in_call;
  const int receiver = HoldToSend(*t, fd, message);
  if (NotesActivity()) NoteDatagram(*t, fd, message.msg_name, message.msg_namelen);
  long posted = 0;
  ssize_t sent;
  if (*may_post && Post(*t, fd, receiver, message, flags, &posted)) {
    t->in_call = was_in_call;  // nobody has seen it yet
    sent = ToErrno(posted);
  } else {
    *may_post = false;
    // The coordinator would take it for something that happens when it finds it.
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
  return sent;
}

// With MSG_WAITALL a stream gives all that is asked for, or what there is at its end.
bool WaitsForAll(int fd, int flags) {
  if ((flags & MSG_WAITALL) == 0 || (flags & (MSG_DONTWAIT | MSG_PEEK | MSG_TRUNC)) != 0) {
    return false;
  }
  int type = 0;
  socklen_t size = sizeof type;
  return RawSyscall(SYS_getsockopt, fd, SOL_SOCKET, SO_TYPE, Arg(&type), Arg(&size)) == 0 &&
         type == SOCK_STREAM && !IsNonBlocking(fd);
}

template <class Whole>
ssize_t ReceiveAll(int fd, msghdr* given, int flags, Whole whole) {
  const Entered t;
  if (t == nullptr) return ToErrno(whole());
  msghdr message{};
  if (!CopyIn(&message, given)) return ToErrno(whole());
  HoldForRead(*t);
  BeginChange(*t);
  Rest rest(message.msg_iov, message.msg_iovlen);
  msghdr part_of = message;
  bool first = true;
  const long done = TransferAll(
      *t, fd, POLLIN, SO_RCVTIMEO, rest,
      [&](const iovec* part, std::size_t n) -> long {
        part_of.msg_iov = const_cast<iovec*>(part);
        part_of.msg_iovlen = n;
        AcknowledgeAtOnce(fd);
        const long got =
            RawSyscall(SYS_recvmsg, fd, Arg(&part_of), (flags & ~MSG_WAITALL) | MSG_DONTWAIT);
        if (got >= 0 && first) {
          ReplaceStamps(&part_of);
          message.msg_namelen = part_of.msg_namelen;
          message.msg_controllen = part_of.msg_controllen;
          message.msg_flags = part_of.msg_flags;
          if (!CopyOut(given, message)) return -EFAULT;
          part_of.msg_controllen = 0;
          first = false;
        }
        return got;
      },
      whole);
  if (done > 0) NoteReceived(*t);
  PassOn(*t);
  return ToErrno(done);
}

}  // namespace

TCS_EXPORT ssize_t read(int fd, void* buffer, std::size_t size) {
  auto whole = [&] { return RawSyscall(SYS_read, fd, Arg(buffer), size); };
  const iovec iov{buffer, size};
  const bool at_once = size == 0 || IsBeyondMemory(buffer, size);
  const ssize_t got = ReadLike(
      fd, {}, [&] { return at_once ? whole() : ReadAtOnce(fd, &iov, 1); }, whole);
  RepeatDraws(fd, &iov, 1, got);
  return got;
}

TCS_EXPORT ssize_t __read_chk(int fd, void* buffer, std::size_t size, std::size_t room) {
  if (size > room) __builtin_trap();
  return read(fd, buffer, size);
}

TCS_EXPORT ssize_t readv(int fd, const iovec* iov, int count) {
  const ssize_t got = ReadLike(
      fd, {}, [&] { return ReadAtOnce(fd, iov, count); },
      [&] { return RawSyscall(SYS_readv, fd, Arg(iov), count); });
  RepeatDraws(fd, iov, static_cast<std::size_t>(count), got);
  return got;
}

TCS_EXPORT ssize_t recvfrom(int fd, void* buffer, std::size_t size, int flags, sockaddr* from,
                            socklen_t* from_size) {
  auto call = [&](int with) {
    return RawSocketCall(SYS_recvfrom, fd, Arg(buffer), size, with, Arg(from), Arg(from_size));
  };
  auto whole = [&] { return call(flags); };
  if (from == nullptr && WaitsForAll(fd, flags)) {
    iovec iov = PieceOf(buffer, size);
    msghdr message{};
    message.msg_iov = &iov;
    message.msg_iovlen = 1;
    return ReceiveAll(fd, &message, flags, whole);
  }
  return ReadLike(
      fd, {ReceivesAtOnce(fd, flags), true, Takes(flags), true},
      [&] { return call(flags | MSG_DONTWAIT); }, whole);
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
  auto call = [&](int with) {
    const long got = RawSyscall(SYS_recvmsg, fd, Arg(message), with);
    if (got >= 0) ReplaceStamps(message);
    return got;
  };
  auto whole = [&] { return call(flags); };
  if (WaitsForAll(fd, flags)) return ReceiveAll(fd, message, flags, whole);
  return ReadLike(
      fd, {ReceivesAtOnce(fd, flags), true, Takes(flags), true},
      [&] { return call(flags | MSG_DONTWAIT); }, whole);
}

// One message is waited for; those that are there with it come along. A timeout is a virtual one.
TCS_EXPORT int recvmmsg(int fd, mmsghdr* messages, unsigned count, int flags, timespec* timeout) {
  const Entered t;
  if (t == nullptr) {
    return static_cast<int>(
        ToErrno(RawSyscall(SYS_recvmmsg, fd, Arg(messages), count, flags, Arg(timeout))));
  }
  auto at_once = [&] {
    AcknowledgeAtOnce(fd);
    const long got = RawSyscall(SYS_recvmmsg, fd, Arg(messages), count, flags | MSG_DONTWAIT, 0);
    for (long i = 0; i < got; ++i) ReplaceStamps(&messages[i].msg_hdr);
    return got;
  };
  timespec limit{};
  if (timeout != nullptr && !CopyIn(&limit, timeout)) return Fail(EFAULT);
  if (!IsValid(limit)) return Fail(EINVAL);
  FdState state = FdState::kReady;
  if (!ReceivesAtOnce(fd, flags)) {
    if (!PollNow(fd, POLLIN) && !WantsMore(fd)) {
      if (const long answer = at_once(); answer != -EAGAIN) {
        return static_cast<int>(ToErrno(answer));
      }
    }
    std::int64_t deadline = SocketDeadline(*t, fd, SO_RCVTIMEO);
    if (timeout != nullptr) deadline = DeadlineAfter(*t, ToNs(limit));
    state = AwaitFd(*t, fd, POLLIN, deadline);
  }
  if (state == FdState::kFailed) return -1;
  // All that are there come along, so all that are from before must be there.
  if (state == FdState::kReady) HoldForRead(*t);
  BeginTaking(*t, fd, true);
  const long result = at_once();
  if (result > 0 && Takes(flags)) {
    NoteReceived(*t);
    if (NotesActivity()) NoteDatagramsReceived(*t, fd, static_cast<std::uint32_t>(result));
  }
  PassOn(*t);
  return static_cast<int>(ToErrno(result));
}

TCS_EXPORT int accept4(int fd, sockaddr* address, socklen_t* size, int flags) {
  auto whole = [&] { return RawSyscall(SYS_accept4, fd, Arg(address), Arg(size), flags); };
  const auto connection = static_cast<int>(ReadLike(
      fd, {.socket = true}, [&] { return AcceptWaits(fd, flags) ? -EAGAIN : whole(); }, whole));
  if (GuestThread* t = Current(); t != nullptr && connection >= 0) {
    SendAtOnce(connection);  // the listener may be from elsewhere
    TellChanged(*t, kBacklogs, 0);
  }
  return connection;
}

TCS_EXPORT int accept(int fd, sockaddr* address, socklen_t* size) {
  return accept4(fd, address, size, 0);
}

TCS_EXPORT ssize_t write(int fd, const void* buffer, std::size_t size) {
  const iovec iov{const_cast<void*>(buffer), size};
  const std::size_t pieces = IsBeyondMemory(buffer, size) ? 0 : 1;  // to be moved in parts
  return WriteAll(fd, &iov, pieces, [&] { return RawSyscall(SYS_write, fd, Arg(buffer), size); });
}

TCS_EXPORT ssize_t writev(int fd, const iovec* iov, int count) {
  return WriteAll(fd, iov, static_cast<std::size_t>(count),
                  [&] { return RawSyscall(SYS_writev, fd, Arg(iov), count); });
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
  return SendAll(t, fd, message, flags, &may_post, [&] {
    return RawSocketCall(SYS_sendto, fd, Arg(buffer), size, flags, Arg(to), to_size);
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
                 [&] { return RawSyscall(SYS_sendmsg, fd, Arg(message), flags); });
}

// What the socket has no room for is waited for, until all have been sent.
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
                [&] { return RawSyscall(SYS_sendmsg, fd, Arg(message), flags); });
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
  for (bool again = false;; again = true) {
    const long result = ConnectOnce(fd, address, size);
    if (result != -EAGAIN || IsShutDown()) return result;
    const Reply reply =
        Exchange(t, Request{.kind = tcs::shm::NotificationKind::kWaitKey,
                            .deadline_ns = deadline,
                            .args = {static_cast<std::int64_t>(kBacklogs), 0, again ? 1 : 0},
                            .interruptible = true});
    if (reply.reason == tcs::shm::WakeReason::kDeadline) return ConnectOnce(fd, address, size);
    if (reply.reason == tcs::shm::WakeReason::kSignal && !RestartsAfterSignal()) return -EINTR;
  }
}

// The other end may be a while away.
long ConnectFar(GuestThread& t, int fd, const sockaddr* address, socklen_t size) {
  const long result = ConnectOnce(fd, address, size);
  if (result != -EINPROGRESS) return result;
  if (!PollNow(fd, POLLOUT)) {
    const int saved = errno;
    const std::int64_t deadline = SocketDeadline(t, fd, SO_SNDTIMEO);
    if (AwaitFd(t, fd, POLLOUT, deadline) == FdState::kFailed) {
      const int error = errno == EAGAIN ? EINPROGRESS : errno;
      errno = saved;
      return -error;
    }
  }
  int error = 0;
  socklen_t error_size = sizeof error;
  RawSyscall(SYS_getsockopt, fd, SOL_SOCKET, SO_ERROR, Arg(&error), Arg(&error_size));
  return -error;
}

}  // namespace

// Connecting is a write: it makes the listener's descriptor readable.
TCS_EXPORT int connect(int fd, const sockaddr* address, socklen_t size) {
  const Entered t;
  if (t != nullptr) {
    const bool may_go_on = BeginWrite(*t);
    if (!ReachesSafely(*t, address, size) && !may_go_on) {
      Exchange(*t, Request{.kind = tcs::shm::NotificationKind::kWrite});
    }
  }
  sa_family_t family = AF_UNSPEC;
  if (t != nullptr && size >= sizeof family && CanRead(address, sizeof family)) {
    family = address->sa_family;
  }
  if (family == AF_UNIX && !IsNonBlocking(fd)) {
    return static_cast<int>(ToErrno(ConnectLocally(*t, fd, address, size)));
  }
  if ((family == AF_INET || family == AF_INET6) && !IsNonBlocking(fd)) {
    return static_cast<int>(ToErrno(ConnectFar(*t, fd, address, size)));
  }
  return static_cast<int>(ToErrno(RawSyscall(SYS_connect, fd, Arg(address), size)));
}
