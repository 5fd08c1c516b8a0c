// poll, select and epoll.
#include <errno.h>
#include <limits.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/select.h>
#include <sys/time.h>

#include <utility>

#include "libtcs_preload/call_file.h"
#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/fd_wait.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/local_sockets.h"
#include "libtcs_preload/outside.h"
#include "libtcs_preload/own_work.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/select_sets.h"
#include "libtcs_preload/signal_mask.h"
#include "libtcs_preload/user_memory.h"
#include "libtcs_preload/virtual_clock.h"

using namespace tcs::preload;
using tcs::shm::MillisecondsToNs;

namespace {

constexpr timespec kNow{};

// The shape of all these calls. Nothing there: wait, and probe again. Something there, or no wait
// wanted: hold, so that the probe finds all that was sent until now. `is_ready` takes nothing away,
// `probe` may (epoll). Both functions return what the kernel returns, 0 for "nothing"; `hold`
// returns once a look misses nothing; `wait(deadline, signals)` returns a WaitResult. A signal ends
// these calls if a handler runs and nothing was found, calls without a timeout too, but for epoll's
// (`looks_first`).
template <class IsReady, class Hold, class Probe, class Wait>
long ProbeAndWait(GuestThread& t, std::int64_t timeout_ns, const MaskedWait& masked,
                  bool looks_first, IsReady is_ready, Hold hold, Probe probe, Wait wait) {
  const std::int64_t deadline = DeadlineAfter(t, timeout_ns);
  if (timeout_ns == 0 || is_ready() != 0 || masked.IsPending()) {
    hold();
    if (const long found = probe(); found != 0) return found;
    if ((timeout_ns != 0 || looks_first) && masked.Deliver()) return -EINTR;
    if (timeout_ns == 0) return 0;
  }
  for (;;) {
    const WaitResult result = wait(deadline, masked.Awaited());
    if (result == WaitResult::kInterrupted && !masked.active()) return -EINTR;
    if (const long found = probe(); found != 0) return found;
    if (masked.Deliver()) return -EINTR;
    if (result == WaitResult::kTimedOut) return 0;
  }
}

template <class IsReady, class Hold, class Probe, class Wait>
int CallWithMask(GuestThread& t, std::int64_t timeout_ns, const sigset_t* mask, bool looks_first,
                 IsReady is_ready, Hold hold, Probe probe, Wait wait) {
  pthread_testcancel();
  const OwnWork own(&t);
  MaskedWait masked(mask);
  const auto probe_as_program = [&] { return AsProgram(t, probe); };
  const long found =
      ProbeAndWait(t, timeout_ns, masked, looks_first, is_ready, hold, probe_as_program, wait);
  masked.Restore();
  if (found == -EINTR) pthread_testcancel();
  return static_cast<int>(ToErrno(found));
}

// The files that poll or select has found under the numbers that it was given. The call looks for
// them by their numbers each time, but is woken by the files only.
class PolledFiles {
 public:
  explicit PolledFiles(GuestThread& thread) : thread_(thread) {}
  ~PolledFiles() {
    if (are_kept_) LeaveFiles(thread_);
  }
  PolledFiles(const PolledFiles&) = delete;
  PolledFiles& operator=(const PolledFiles&) = delete;

  WaitResult Wait(const pollfd* fds, unsigned long count, std::int64_t deadline_ns,
                  unsigned long signals) {
    using tcs::shm::KeepFiles;
    const WaitResult result = WaitForFds(
        thread_, fds, count, deadline_ns,
        {.signals = signals, .keep = are_kept_ ? KeepFiles::kAgain : KeepFiles::kForPoll});
    are_kept_ = thread_.keeps_files;
    return result;
  }

 private:
  GuestThread& thread_;
  bool are_kept_ = false;
};

bool IsReadableMask(const sigset_t* mask) { return mask == nullptr || CanRead(mask, 8); }

int PollNs(GuestThread& t, pollfd* fds, nfds_t count, std::int64_t timeout_ns,
           const sigset_t* mask) {
  if (!IsReadableMask(mask)) return Fail(EFAULT);
  auto probe = [&] {
    const long found = RawSyscall(SYS_ppoll, Arg(fds), static_cast<long>(count), Arg(&kNow), 0, 0);
    return WithoutHidden(t, fds, count, found);
  };
  auto hold = [&] {
    BeginLooks(t, fds, count);
    if (!AreSafeLooks(t, fds, count, NowNs(t))) HoldForRead(t);
  };
  PolledFiles files(t);
  return CallWithMask(t, timeout_ns, mask, true, probe, hold, probe,
                      [&](std::int64_t deadline, unsigned long signals) {
                        return files.Wait(fds, count, deadline, signals);
                      });
}

int SelectNs(GuestThread& t, int n, fd_set* r, fd_set* w, fd_set* e, std::int64_t timeout_ns,
             const sigset_t* mask) {
  SelectSets sets(n, r, w, e);
  if (!IsReadableMask(mask)) return Fail(EFAULT);
  if (sets.error() != 0) return Fail(sets.error());
  bool has_waited = false;
  PolledFiles files(t);
  auto probe = [&] { return sets.WithoutHidden(t, has_waited ? sets.ProbeAgain() : sets.Probe()); };
  auto wait = [&](std::int64_t deadline, unsigned long signals) {
    has_waited = true;
    unsigned long count = 0;
    const pollfd* wanted = sets.Wanted(&count);
    return files.Wait(wanted, count, deadline, signals);
  };
  auto hold = [&] {
    unsigned long count = 0;
    const pollfd* wanted = sets.Wanted(&count);
    BeginLooks(t, wanted, count);
    HoldForRead(t);
  };
  const int found = CallWithMask(t, timeout_ns, mask, true, probe, hold, probe, wait);
  if (found < 0) return found;
  const int error = sets.PutBack();
  return error == 0 ? found : Fail(error);
}

// Takes nothing: an event that cannot be handed over stays where it is.
long PeekEvents(int epfd) {
  constexpr long kNowhere = 1;
  const long found = RawSyscall(SYS_epoll_wait, epfd, kNowhere, 1, 0);
  return found == -EFAULT ? 1 : found;
}

int EpollNs(GuestThread& t, int epfd, epoll_event* events, int max, std::int64_t timeout_ns,
            const sigset_t* mask) {
  if (!IsReadableMask(mask)) return Fail(EFAULT);
  // The kernel refuses arguments for which no call could hand over events before it looks; a wait
  // would come first here.
  constexpr int kMostEvents = INT_MAX / static_cast<int>(sizeof(epoll_event));
  if (max <= 0 || max > kMostEvents || reinterpret_cast<std::intptr_t>(events) < 0) {
    return static_cast<int>(ToErrno(RawSyscall(SYS_epoll_wait, epfd, Arg(events), max, 0)));
  }
  bool again = false;
  CallFile file(t, epfd, tcs::shm::KeepFiles::kForSet);
  const int found = CallWithMask(
      t, timeout_ns, mask, false, [&] { return PeekEvents(epfd); },
      [&] {
        BeginLookIntoSet(t, epfd);
        HoldForRead(t);
      },
      [&] {
        const HiddenMembers hidden(t, file.fd());
        const long there = RawSyscall(SYS_epoll_wait, file.fd(), Arg(events), max, 0);
        return hidden.TakeOut(events, there);
      },
      [&](std::int64_t deadline, unsigned long signals) {
        return file.Wait(POLLIN, deadline,
                         {OneEvent::kForTheLast, std::exchange(again, true), signals});
      });
  PassOn(t);
  return found;
}

// Null means for ever.
bool TimeoutToNs(const timespec* timeout, std::int64_t* ns) {
  *ns = -1;
  if (timeout == nullptr) return true;
  *ns = ToNs(*timeout);
  return IsValid(*timeout);
}

}  // namespace

TCS_EXPORT int poll(pollfd* fds, nfds_t count, int timeout_ms) {
  const Entered t;
  if (t == nullptr)
    return static_cast<int>(ToErrno(RawSyscall(SYS_poll, Arg(fds), count, timeout_ms)));
  return PollNs(*t, fds, count, MillisecondsToNs(timeout_ms), nullptr);
}

TCS_EXPORT int __poll_chk(pollfd* fds, nfds_t count, int timeout_ms, std::size_t size) {
  if (size / sizeof *fds < count) __builtin_trap();
  return poll(fds, count, timeout_ms);
}

TCS_EXPORT int ppoll(pollfd* fds, nfds_t count, const timespec* timeout, const sigset_t* mask) {
  const Entered t;
  if (t == nullptr) {
    timespec left = timeout != nullptr ? *timeout : timespec{};
    return static_cast<int>(ToErrno(
        RawSyscall(SYS_ppoll, Arg(fds), count, timeout != nullptr ? Arg(&left) : 0, Arg(mask), 8)));
  }
  std::int64_t timeout_ns;
  if (!TimeoutToNs(timeout, &timeout_ns)) return Fail(EINVAL);
  if (!IsReadableMask(mask)) return Fail(EFAULT);
  return PollNs(*t, fds, count, timeout_ns, mask);
}

TCS_EXPORT int __ppoll_chk(pollfd* fds, nfds_t count, const timespec* timeout, const sigset_t* mask,
                           std::size_t size) {
  if (size / sizeof *fds < count) __builtin_trap();
  return ppoll(fds, count, timeout, mask);
}

TCS_EXPORT int select(int n, fd_set* r, fd_set* w, fd_set* e, timeval* timeout) {
  const Entered t;
  if (t == nullptr) {
    return static_cast<int>(
        ToErrno(RawSyscall(SYS_select, n, Arg(r), Arg(w), Arg(e), Arg(timeout))));
  }
  if (timeout == nullptr) return SelectNs(*t, n, r, w, e, -1, nullptr);
  if (timeout->tv_sec < 0 || timeout->tv_usec < 0) return Fail(EINVAL);
  const std::int64_t timeout_ns = ToNs(*timeout);
  const std::int64_t start = NowNs(*t);
  const int found = SelectNs(*t, n, r, w, e, timeout_ns, nullptr);
  // Linux leaves in `timeout` the time that has not been waited.
  const std::int64_t left = timeout_ns - (NowNs(*t) - start);
  *timeout = ToTimeval(left > 0 ? left : 0);
  return found;
}

TCS_EXPORT int __select(int n, fd_set* r, fd_set* w, fd_set* e, timeval* timeout) {
  return select(n, r, w, e, timeout);
}

TCS_EXPORT int pselect(int n, fd_set* r, fd_set* w, fd_set* e, const timespec* timeout,
                       const sigset_t* mask) {
  const Entered t;
  if (t == nullptr) {
    timespec left = timeout != nullptr ? *timeout : timespec{};
    const struct {
      const sigset_t* set;
      std::size_t size;
    } argument{mask, 8};
    return static_cast<int>(
        ToErrno(RawSyscall(SYS_pselect6, n, Arg(r), Arg(w), Arg(e),
                           timeout != nullptr ? Arg(&left) : 0, Arg(&argument))));
  }
  std::int64_t timeout_ns;
  if (!TimeoutToNs(timeout, &timeout_ns)) return Fail(EINVAL);
  if (!IsReadableMask(mask)) return Fail(EFAULT);
  return SelectNs(*t, n, r, w, e, timeout_ns, mask);
}

TCS_EXPORT int epoll_pwait(int epfd, epoll_event* events, int max, int timeout_ms,
                           const sigset_t* mask) {
  const Entered t;
  if (t == nullptr) {
    return static_cast<int>(
        ToErrno(RawSyscall(SYS_epoll_pwait, epfd, Arg(events), max, timeout_ms, Arg(mask), 8)));
  }
  return EpollNs(*t, epfd, events, max, MillisecondsToNs(timeout_ms), mask);
}

TCS_EXPORT int epoll_wait(int epfd, epoll_event* events, int max, int timeout_ms) {
  return epoll_pwait(epfd, events, max, timeout_ms, nullptr);
}

TCS_EXPORT int epoll_pwait2(int epfd, epoll_event* events, int max, const timespec* timeout,
                            const sigset_t* mask) {
  const Entered t;
  if (t == nullptr) {
    return static_cast<int>(
        ToErrno(RawSyscall(SYS_epoll_pwait2, epfd, Arg(events), max, Arg(timeout), Arg(mask), 8)));
  }
  std::int64_t timeout_ns;
  if (timeout != nullptr && !CanRead(timeout, sizeof *timeout)) return Fail(EFAULT);
  if (!TimeoutToNs(timeout, &timeout_ns)) return Fail(EINVAL);
  return EpollNs(*t, epfd, events, max, timeout_ns, mask);
}
