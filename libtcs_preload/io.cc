// Reading descriptors that can make a program wait: sockets, pipes, terminals.
//
// Kernel-carried data is there at once for any thread that looks. So a read waits until no thread
// can write at an earlier virtual time (and a write until no thread can look at an earlier one:
// writes.cc).
#include <errno.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include "libtcs_preload/call_file.h"
#include "libtcs_preload/datagram_notes.h"
#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/fd_wait.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/kernel_objects.h"
#include "libtcs_preload/memory_devices.h"
#include "libtcs_preload/non_blocking.h"
#include "libtcs_preload/outside.h"
#include "libtcs_preload/pieces.h"
#include "libtcs_preload/random.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/reading.h"
#include "libtcs_preload/receipts.h"
#include "libtcs_preload/socket_timestamps.h"
#include "libtcs_preload/tcp.h"
#include "libtcs_preload/transfer.h"
#include "libtcs_preload/user_memory.h"
#include "libtcs_preload/virtual_clock.h"

using namespace tcs::preload;

namespace {

// Whether a call with these flags takes away what it receives.
bool Takes(int flags) { return (flags & (MSG_PEEK | MSG_ERRQUEUE)) == 0; }

// With MSG_WAITALL a stream gives all that is asked for, or what there is at its end.
bool WaitsForAll(int fd, int flags) {
  if ((flags & MSG_WAITALL) == 0 || (flags & (MSG_DONTWAIT | MSG_PEEK | MSG_TRUNC)) != 0) {
    return false;
  }
  return TypeOfSocket(fd) == SOCK_STREAM && !IsNonBlocking(fd);
}

template <class Whole>
ssize_t ReceiveAll(int fd, msghdr* given, int flags, Whole whole) {
  const Entered t;
  if (t == nullptr) return ToErrno(whole(fd));
  msghdr message{};
  if (!CopyIn(&message, given)) return ToErrno(whole(fd));
  HoldForRead(*t);
  BeginChange(*t);
  Rest rest(message.msg_iov, message.msg_iovlen);
  msghdr part_of = message;
  bool first = true;
  const long done = TransferAll(
      *t, fd, POLLIN, SO_RCVTIMEO, rest, 0,
      [&](int from, const iovec* part, std::size_t n) -> long {
        part_of.msg_iov = const_cast<iovec*>(part);
        part_of.msg_iovlen = n;
        if (IsHidden(*t, OutsideOf(from))) return -EAGAIN;
        AcknowledgeAtOnce(from);
        const long got =
            RawSyscall(SYS_recvmsg, from, Arg(&part_of), (flags & ~MSG_WAITALL) | MSG_DONTWAIT);
        if (got >= 0 && first) {
          ReplaceTimestamps(&part_of);
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
  if (done >= 0) NoteTakes(*t, fd);
  PassOn(*t);
  return ToErrno(done);
}

long ReadOnce(int fd, void* buffer, std::size_t size) {
  const auto read = [fd](void* to, std::size_t n) {
    return RawSyscall(SYS_read, fd, Arg(to), static_cast<long>(n));
  };
  const long got = read(buffer, size);
  if (!MayBeCutShort(got, size) || !IsMemoryDevice(fd)) return got;
  return Completed(buffer, size, got, read);
}

// `is_beyond`: the kernel never waits for anything to come into such buffers.
template <class Call>
ssize_t ReadInto(int fd, const iovec* iov, int count, bool is_beyond, Call call) {
  const auto repeated = [&](int from, long got) {
    RepeatDraws(from, iov, static_cast<std::size_t>(count), got);
    return got;
  };
  const auto whole = [&](int from) { return repeated(from, call(from)); };
  const auto try_it = [&](int from) {
    if (is_beyond) return whole(from);
    const long got = TryRead(from, iov, count);
    return got == -EOPNOTSUPP ? kNoForm : repeated(from, got);
  };
  const auto look = [&](int from) {
    const long answer = try_it(from);
    return answer == kNoForm ? TryReadWithoutForm(from, iov, count) : answer;
  };
  const std::uint64_t form_ticks = g_header != nullptr ? g_header->read_form_ticks : 0;
  return ReadLike(fd, {}, Forms{look, try_it, whole, form_ticks});
}

}  // namespace

TCS_EXPORT ssize_t read(int fd, void* buffer, std::size_t size) {
  const iovec iov{buffer, size};
  const bool is_beyond = size == 0 || IsBeyondMemory(buffer, size);
  return ReadInto(fd, &iov, 1, is_beyond, [&](int from) { return ReadOnce(from, buffer, size); });
}

TCS_EXPORT ssize_t __read_chk(int fd, void* buffer, std::size_t size, std::size_t room) {
  if (size > room) __builtin_trap();
  return read(fd, buffer, size);
}

TCS_EXPORT ssize_t readv(int fd, const iovec* iov, int count) {
  return ReadInto(fd, iov, count, false,
                  [&](int from) { return RawSyscall(SYS_readv, from, Arg(iov), count); });
}

namespace {

// `call(fd, flags)`: recvfrom or recvmsg. With MSG_WAITALL, where ReceiveAll is not for the call,
// the call waits for more than what a form that cannot wait takes.
template <class Call>
ssize_t Receive(int fd, int flags, Call call) {
  const auto look = [&](int from) { return call(from, flags | MSG_DONTWAIT); };
  const auto try_it = [&](int from) { return (flags & MSG_WAITALL) != 0 ? kNoForm : look(from); };
  const auto whole = [&](int from) { return call(from, flags); };
  return ReadLike(fd, {ReceivesAtOnce(fd, flags), true, Takes(flags), true},
                  Forms{look, try_it, whole});
}

}  // namespace

TCS_EXPORT ssize_t recvfrom(int fd, void* buffer, std::size_t size, int flags, sockaddr* from,
                            socklen_t* from_size) {
  const auto call = [&](int at, int with) {
    return RawSocketCall(SYS_recvfrom, at, Arg(buffer), size, with, Arg(from), Arg(from_size));
  };
  if (from == nullptr && WaitsForAll(fd, flags)) {
    iovec iov = PieceOf(buffer, size);
    msghdr message{};
    message.msg_iov = &iov;
    message.msg_iovlen = 1;
    return ReceiveAll(fd, &message, flags, [&](int at) { return call(at, flags); });
  }
  return Receive(fd, flags, call);
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
  const auto call = [&](int from, int with) {
    const long got = RawSyscall(SYS_recvmsg, from, Arg(message), with);
    if (got >= 0) ReplaceTimestamps(message);
    return got;
  };
  if (WaitsForAll(fd, flags)) {
    return ReceiveAll(fd, message, flags, [&](int from) { return call(from, flags); });
  }
  return Receive(fd, flags, call);
}

// The call waits for one message; other messages that are there with it come along. A timeout is a
// virtual one.
TCS_EXPORT int recvmmsg(int fd, mmsghdr* messages, unsigned count, int flags, timespec* timeout) {
  const Entered t;
  if (t == nullptr) {
    return static_cast<int>(
        ToErrno(RawSyscall(SYS_recvmmsg, fd, Arg(messages), count, flags, Arg(timeout))));
  }
  const auto try_it = [&](int from) {
    AcknowledgeAtOnce(from);
    const long got = RawSyscall(SYS_recvmmsg, from, Arg(messages), count, flags | MSG_DONTWAIT, 0);
    for (long i = 0; i < got; ++i) ReplaceTimestamps(&messages[i].msg_hdr);
    return got;
  };
  const auto take = [&](int from) {
    BeginTaking(*t, from, true);
    const long result = IsHidden(*t, OutsideOf(from)) ? -EAGAIN : try_it(from);
    if (result > 0 && Takes(flags)) {
      NoteTakes(*t, from);
      NoteReceived(*t);
      if (NotesActivity()) NoteDatagramsReceived(*t, from, static_cast<std::uint32_t>(result));
    }
    return result;
  };
  timespec limit{};
  if (timeout != nullptr && !CopyIn(&limit, timeout)) return Fail(EFAULT);
  if (!IsValid(limit)) return Fail(EINVAL);
  const bool never_waits = ReceivesAtOnce(fd, flags) || IsNonBlocking(fd);
  OutsidePlace* place = OutsideOf(fd);
  if (never_waits && IsHiddenFromLook(*t, fd)) return Fail(EAGAIN);
  if (never_waits || (!IsHidden(*t, place) && PollNow(fd, POLLIN))) {
    // All messages that are there come along, so all messages from before must be there.
    HoldForRead(*t);
    const long result = take(fd);
    if (never_waits || result != -EAGAIN) {
      return static_cast<int>(PassOnAfter(*t, result));
    }
  } else if (!WantsMore(fd) && place == nullptr) {
    if (const long answer = try_it(fd); answer != -EAGAIN) return static_cast<int>(ToErrno(answer));
  }
  std::int64_t deadline = SocketDeadline(*t, fd, SO_RCVTIMEO);
  if (timeout != nullptr) deadline = DeadlineAfter(*t, ToNs(limit));
  CallFile file(*t, fd);
  for (bool again = false;; again = true) {
    const FdState state = AwaitEvent(file, POLLIN, deadline, again);
    if (state == FdState::kFailed) return -1;
    const long result = take(file.fd());
    if (result != -EAGAIN || state == FdState::kTimedOut) {
      return static_cast<int>(PassOnAfter(*t, result));
    }
  }
}

TCS_EXPORT int accept4(int fd, sockaddr* address, socklen_t* size, int flags) {
  const auto whole = [&](int from) {
    return RawSyscall(SYS_accept4, from, Arg(address), Arg(size), flags);
  };
  const auto look = [&](int from) { return AcceptWaits(from, flags) ? -EAGAIN : whole(from); };
  const auto try_it = [](int) { return kNoForm; };
  const auto connection =
      static_cast<int>(ReadLike(fd, {.socket = true}, Forms{look, try_it, whole}));
  if (GuestThread* t = Current(); t != nullptr && connection >= 0) {
    SendAtOnce(connection);  // the listener may be from elsewhere
    TellChanged(*t, tcs::shm::KernelObjectKind::kBacklogs, 0);
  }
  return connection;
}

TCS_EXPORT int accept(int fd, sockaddr* address, socklen_t* size) {
  return accept4(fd, address, size, 0);
}
