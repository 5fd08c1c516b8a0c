// Waiting for a signal handler and nothing else.
#include <errno.h>
#include <signal.h>
#include <unistd.h>

#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/preemption.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/user_memory.h"

using namespace tcs::preload;

namespace {

constexpr std::size_t kSetSize = 8;  // the kernel's sigset_t; the C library's begins with it

// True if a pending signal will run a handler, end or stop the process. The kernel drops all others
// as soon as they are no longer blocked, and goes on waiting.
bool EndsWaits(unsigned long pending) {
  constexpr unsigned long kDroppedByDefault =
      1ul << (SIGCHLD - 1) | 1ul << (SIGCONT - 1) | 1ul << (SIGURG - 1) | 1ul << (SIGWINCH - 1);
  for (int number = 1; number < NSIG; ++number) {
    const unsigned long bit = 1ul << (number - 1);
    unsigned long action[4] = {};  // the handler first
    if ((pending & bit) == 0) continue;
    RawSyscall(SYS_rt_sigaction, number, 0, Arg(action), kSetSize);
    const auto handler = reinterpret_cast<sighandler_t>(action[0]);
    const bool dropped =
        handler == SIG_IGN || (handler == SIG_DFL && (kDroppedByDefault & bit) != 0);
    if (!dropped) return true;
  }
  return false;
}

// `mask` is in place while the thread waits, atomically, for the kernel does that part.
int SuspendWith(GuestThread& t, const unsigned long* mask) {
  unsigned long pending = 0;
  RawSyscall(SYS_rt_sigpending, Arg(&pending), kSetSize);
  const unsigned long kept = *mask | OwnSignalsHeldInWaits();
  if (EndsWaits(pending & ~kept) || IsShutDown()) {
    RawSyscall(SYS_rt_sigsuspend, Arg(&kept), kSetSize);  // handled at once
  } else {
    // Until the kernel puts the mask in place no handler may run: such a handler would not end the
    // wait.
    const unsigned long all = ~0ul;
    unsigned long before = 0;
    RawSyscall(SYS_rt_sigprocmask, SIG_SETMASK, Arg(&all), Arg(&before), kSetSize);
    Exchange(t, Request{.kind = tcs::shm::NotificationKind::kIdle,
                        .args = {1, static_cast<std::int64_t>(*mask)},
                        .suspend_mask = mask});
    RawSyscall(SYS_rt_sigprocmask, SIG_SETMASK, Arg(&before), 0, kSetSize);
  }
  return Fail(EINTR);
}

}  // namespace

TCS_EXPORT int pause(void) {
  const Entered t;
  unsigned long mask = 0;
  RawSyscall(SYS_rt_sigprocmask, SIG_BLOCK, 0, Arg(&mask), kSetSize);
  if (t == nullptr)
    return static_cast<int>(ToErrno(RawSyscall(SYS_rt_sigsuspend, Arg(&mask), kSetSize)));
  return SuspendWith(*t, &mask);
}

TCS_EXPORT int sigsuspend(const sigset_t* mask) {
  const Entered t;
  if (t == nullptr)
    return static_cast<int>(ToErrno(RawSyscall(SYS_rt_sigsuspend, Arg(mask), kSetSize)));
  unsigned long wanted;
  if (!CopyIn(&wanted, reinterpret_cast<const unsigned long*>(mask))) return Fail(EFAULT);
  return SuspendWith(*t, &wanted);
}
