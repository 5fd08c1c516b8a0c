// How calls that read a descriptor look, wait and take: read, recv and their kin, and accept.
//
// Async-signal-safe.
#pragma once

#include <errno.h>
#include <poll.h>
#include <pthread.h>
#include <sys/socket.h>
#include <unistd.h>

#include "libtcs_preload/call_file.h"
#include "libtcs_preload/datagram_notes.h"
#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/fd_wait.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/local_sockets.h"
#include "libtcs_preload/non_blocking.h"
#include "libtcs_preload/outside.h"
#include "libtcs_preload/own_work.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/receipts.h"
#include "libtcs_preload/tcp.h"
#include "libtcs_preload/terminals.h"
#include "libtcs_preload/timer_fds.h"
#include "libtcs_preload/virtual_clock.h"

namespace tcs::preload {

// A thread that waits to write may find room after a read. Whether a read makes room is asked only
// where that has the thread wait for its next call (CountCall).
inline void BeginTaking(GuestThread& t, int fd, bool socket) {
  if (socket && g_header->is_unprivileged != 0 && !ReadingMakesRoom(fd)) return;
  BeginChange(t);
}

struct Reads {
  bool dont_wait = false, socket = false, takes = true;
  bool is_receive = false;  // recv and its kin
};

// The forms of a call that reads a descriptor. `look`: the answer that the kernel gives without
// waiting although nothing is there, or -EAGAIN. `try_it`: the kernel's answer in a form that
// cannot wait: -EAGAIN, or kNoForm. `call`: the call as the program has made it.
// `try_ticks`: what `try_it` takes more than `call` where something is there.
template <class Look, class Try, class Call>
struct Forms {
  Look look;
  Try try_it;
  Call call;
  std::uint64_t try_ticks = 0;
};
template <class Look, class Try, class Call>
Forms(Look, Try, Call, std::uint64_t = 0) -> Forms<Look, Try, Call>;

// -1: the descriptor is no socket.
inline int TypeOfSocket(int fd) {
  int type = 0;
  socklen_t size = sizeof type;
  const long result = RawSyscall(SYS_getsockopt, fd, SOL_SOCKET, SO_TYPE, Arg(&type), Arg(&size));
  return result == 0 ? type : -1;
}

// Reads a datagram socket. A datagram that is there is taken at once, because nothing that still
// comes is before it. Where nothing is there, and the call does not wait, that is so once nothing
// can come any more. False where the call has to wait.
template <class Look>
bool ReadDatagram(GuestThread& t, int fd, Reads reads, Look look, ssize_t* result) {
  const std::int64_t now = NowNs(t);
  const SafeTimes safe = SafeTimesOf(t);
  BeginTaking(t, fd, true);
  const auto look_as_program = [&] { return AsProgram(t, [&] { return look(fd); }); };
  long got = look_as_program();
  if (got == -EAGAIN) {
    if (!reads.dont_wait && !IsNonBlocking(fd)) return false;
    if (!IsSafeLook(t, fd, now, safe)) {
      HoldForRead(t);
      BeginTaking(t, fd, true);
      got = look_as_program();
    }
    if (got == -EAGAIN) AnswerByLook(t);
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

inline ssize_t PassOnAfter(GuestThread& t, long result) {
  PassOn(t);
  return ToErrno(result);
}

// How a call takes what is there, and what the thread notes of it.
template <class Look, class Try, class Call>
class Taker {
 public:
  Taker(GuestThread& t, FdKind kind, bool takes, const Forms<Look, Try, Call>& forms)
      : t_(t), kind_(kind), takes_(takes), acknowledges_(IsSocket()), forms_(forms) {}

  bool IsSocket() const { return kind_ == FdKind::kSocket; }
  bool HasForm() const { return has_form_; }
  void UseNoForm() { has_form_ = false; }

  // Takes by the call itself, which may wait.
  long Make(int fd) {
    const long result = Take(fd, [this](int from) { return MakeOn(from); });
    if (result == -EAGAIN) AnswerByLook(t_);
    return result;
  }
  // -EAGAIN: nothing is there.
  long TryIt(int fd) {
    return Take(fd, [this](int from) {
      const long result = has_form_ ? AsProgram(
                                          t_, [&] { return forms_.try_it(from); }, forms_.try_ticks)
                                    : kNoForm;
      has_form_ = result != kNoForm;
      if (has_form_) return result;
      return PollNow(from, POLLIN) ? MakeOn(from) : -EAGAIN;
    });
  }

 private:
  long MakeOn(int from) {
    return AsProgram(t_, [&] { return forms_.call(from); });
  }
  template <class By>
  long Take(int fd, By by) {
    if (acknowledges_) acknowledges_ = AcknowledgeAtOnce(fd);
    BeginTaking(t_, fd, IsSocket());
    const long result = by(fd);
    if (!takes_ || result < 0) return result;
    if (result > 0 && IsSocket()) NoteReceived(t_);
    if (result > 0 && !IsSocket()) NoteReceivedFrom(t_, fd, kind_ == FdKind::kOther);
    if (IsSocket() && NotesActivity()) NoteDatagramsReceived(t_, fd, 1);
    return result;
  }

  GuestThread& t_;
  const FdKind kind_;
  const bool takes_;
  bool acknowledges_, has_form_ = true;
  const Forms<Look, Try, Call>& forms_;
};

// Waits and reads, where nothing is there.
template <class Take>
ssize_t WaitAndRead(GuestThread& t, int fd, Take& take) {
  std::int64_t deadline = take.IsSocket() ? SocketDeadline(t, fd, SO_RCVTIMEO) : shm::kNeverNs;
  // A terminal may be set to give up at a deadline, and then reads nothing.
  const std::int64_t timeout = take.IsSocket() ? shm::kNeverNs : ReadTimeoutOf(fd);
  if (timeout == 0) {
    HoldForRead(t);
    return ToErrno(take.Make(fd));
  }
  if (timeout != shm::kNeverNs) deadline = DeadlineAfter(t, timeout);
  CallFile file(t, fd);
  for (bool again = false;; again = true) {
    const FdState state = AwaitEvent(file, POLLIN, deadline, again);
    if (state == FdState::kFailed) return -1;
    const bool is_hidden = IsHidden(t, OutsideOf(file.fd()));
    const long result = is_hidden ? -EAGAIN : take.TryIt(file.fd());
    if (result != -EAGAIN) return PassOnAfter(t, result);
    if (state == FdState::kTimedOut) return timeout != shm::kNeverNs ? 0 : Fail(EAGAIN);
  }
}

// Data that comes from outside of the run is there when it is to be seen.
template <class Take>
ssize_t ReadFromOutside(GuestThread& t, int fd, Reads reads, OutsidePlace* place, Take& take) {
  ssize_t got = 0;
  if (reads.dont_wait || IsNonBlocking(fd)) {
    if (IsHiddenFromLook(t, fd)) return Fail(EAGAIN);
    got = ToErrno(take.Make(fd));
  } else {
    if (take.IsSocket() && WantsMore(fd)) take.UseNoForm();
    const long there = IsHidden(t, place) ? -EAGAIN : take.TryIt(fd);
    got = there != -EAGAIN ? PassOnAfter(t, there) : WaitAndRead(t, fd, take);
  }
  if (got >= 0 && reads.takes) NoteTakes(t, fd);
  return got;
}

template <class Look, class Try, class Call>
ssize_t ReadLike(int fd, Reads reads, Forms<Look, Try, Call> forms) {
  const Entered t;
  pthread_testcancel();
  if (t == nullptr) return ToErrno(forms.call(fd));
  const OwnWork own(t);
  if (OutsidePlace* place = OutsideOf(fd); place != nullptr) {
    FdKind kind = FdKind::kOther;
    CanWait(fd, &kind);
    Taker take(*t, kind, reads.takes, forms);
    return ReadFromOutside(*t, fd, reads, place, take);
  }
  ssize_t got = 0;
  FdKind kind = FdKind::kSocket;
  const int type = reads.is_receive ? TypeOfSocket(fd) : -1;
  if (type == SOCK_DGRAM && ReadDatagram(*t, fd, reads, forms.look, &got)) return got;
  if (type < 0 && !CanWait(fd, &kind)) {
    return ToErrno(AsProgram(*t, [&] { return forms.call(fd); }));
  }
  Taker take(*t, kind, reads.takes, forms);
  if (type == SOCK_DGRAM) return WaitAndRead(*t, fd, take);
  const bool misses_nothing =
      FindTimerFd(fd) == nullptr && NowNs(*t) <= t->slot->clock.read_safe_ns;
  // What is there is taken before it is asked whether the call may wait: mostly something is there.
  const bool is_tried = misses_nothing && !reads.dont_wait && !take.IsSocket();
  if (is_tried) {
    if (const long result = take.TryIt(fd); result != -EAGAIN) {
      return t->passes_on && IsNonBlocking(fd) ? ToErrno(result) : PassOnAfter(*t, result);
    }
  }
  bool has_looked = is_tried && take.HasForm();
  if (reads.dont_wait || IsNonBlocking(fd)) {
    if (has_looked) {
      AnswerByLook(*t);
      return Fail(EAGAIN);
    }
    HoldForReadFrom(*t, fd, reads.socket);
    return ToErrno(take.Make(fd));
  }
  const auto wants_more = [&] { return take.IsSocket() && WantsMore(fd); };
  if (misses_nothing && !is_tried && !wants_more()) {
    if (const long result = take.TryIt(fd); result != -EAGAIN) return PassOnAfter(*t, result);
    has_looked = take.HasForm();
  } else if (!is_tried && PollNow(fd, POLLIN)) {
    if (!HoldForReadFrom(*t, fd, reads.socket)) return PassOnAfter(*t, take.Make(fd));
    // While the thread held, another thread may have taken what was there.
    if (wants_more()) take.UseNoForm();
    if (const long result = take.TryIt(fd); result != -EAGAIN) return PassOnAfter(*t, result);
  } else if (wants_more()) {
    take.UseNoForm();
    has_looked = true;
  }
  if (!has_looked) {
    const long answer = AsProgram(*t, [&] { return forms.look(fd); });
    if (answer != -EAGAIN) return ToErrno(answer);
  }
  return WaitAndRead(*t, fd, take);
}

}  // namespace tcs::preload
