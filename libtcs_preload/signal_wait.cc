// Waiting for a signal to accept, without a handler.
#include <errno.h>
#include <signal.h>
#include <time.h>

#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/preemption.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/user_memory.h"
#include "libtcs_preload/virtual_clock.h"

using namespace tcs::preload;
using tcs::shm::NotificationKind;
using tcs::shm::WakeReason;

namespace {

constexpr std::size_t kSetSize = 8;  // the kernel's sigset_t; the C library's begins with it

// As the kernel does it: while the thread waits, the set is neither handled nor ends the process.
class Blocked {
 public:
  explicit Blocked(unsigned long set) {
    RawSyscall(SYS_rt_sigprocmask, SIG_BLOCK, Arg(&set), Arg(&before_), kSetSize);
  }
  ~Blocked() { RawSyscall(SYS_rt_sigprocmask, SIG_SETMASK, Arg(&before_), 0, kSetSize); }
  Blocked(const Blocked&) = delete;
  Blocked& operator=(const Blocked&) = delete;

 private:
  unsigned long before_ = 0;
};

bool IsPending(unsigned long set) {
  unsigned long pending = 0;
  RawSyscall(SYS_rt_sigpending, Arg(&pending), kSetSize);
  return (pending & set) != 0;
}

// The signal, or -errno; -EAGAIN at the deadline.
long Accept(GuestThread& t, unsigned long set, siginfo_t* info, std::int64_t timeout_ns) {
  const auto probe = [&] {
    const timespec now{};
    return RawSyscall(SYS_rt_sigtimedwait, Arg(&set), Arg(info), Arg(&now), kSetSize);
  };
  const std::int64_t deadline = DeadlineAfter(t, timeout_ns);
  const Blocked blocked(set);
  if (timeout_ns == 0 || IsPending(set)) {
    HoldForRead(t);
    const long found = probe();
    if (found != -EAGAIN || timeout_ns == 0) return found;
  }
  for (;;) {
    if (IsShutDown()) return RawSyscall(SYS_rt_sigtimedwait, Arg(&set), Arg(info), 0, kSetSize);
    const Reply reply = Exchange(t, Request{.kind = NotificationKind::kIdle,
                                            .deadline_ns = deadline,
                                            .args = {2, static_cast<std::int64_t>(set)},
                                            .interruptible = true});
    const long found = probe();
    if (found != -EAGAIN || reply.reason == WakeReason::kDeadline) return found;
    if (reply.reason == WakeReason::kSignal) return -EINTR;
  }
}

int TimedWait(const sigset_t* set, siginfo_t* info, const timespec* timeout) {
  const Entered t;
  siginfo_t found{};
  long signal;
  if (t == nullptr) {
    signal = RawSyscall(SYS_rt_sigtimedwait, Arg(set), Arg(&found), Arg(timeout), kSetSize);
  } else {
    unsigned long wanted;
    timespec limit{};
    if (!CopyIn(&wanted, reinterpret_cast<const unsigned long*>(set))) return Fail(EFAULT);
    if (timeout != nullptr && !CopyIn(&limit, timeout)) return Fail(EFAULT);
    if (!IsValid(limit)) return Fail(EINVAL);
    constexpr unsigned long kNeverAccepted = 1ul << (SIGKILL - 1) | 1ul << (SIGSTOP - 1);
    signal = Accept(*t, wanted & ~kNeverAccepted & ~OwnSignals(), &found,
                    timeout == nullptr ? -1 : ToNs(limit));
    if (signal > 0 && found.si_code == SI_TIMER) {
      // The signal was sent before these overruns happened.
      found.si_overrun =
          static_cast<int>(Exchange(*t, Request{.kind = NotificationKind::kTimerOverrun,
                                                .args = {found.si_timerid, 1}})
                               .values[0]);
    }
  }
  if (signal < 0) return static_cast<int>(ToErrno(signal));
  if (found.si_code == SI_TKILL) found.si_code = SI_USER;  // as the C library has it
  if (info != nullptr && !CopyOut(info, found)) return Fail(EFAULT);
  return static_cast<int>(signal);
}

}  // namespace

TCS_EXPORT int sigtimedwait(const sigset_t* set, siginfo_t* info, const timespec* timeout) {
  return TimedWait(set, info, timeout);
}

TCS_EXPORT int sigwaitinfo(const sigset_t* set, siginfo_t* info) {
  return TimedWait(set, info, nullptr);
}

TCS_EXPORT int sigwait(const sigset_t* set, int* signal) {
  const int saved = errno;
  int found;
  do {
    found = TimedWait(set, nullptr, nullptr);
  } while (found < 0 && errno == EINTR);
  const int error = errno;
  errno = saved;
  if (found < 0) return error;
  *signal = found;
  return 0;
}
