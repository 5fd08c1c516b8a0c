// The signal mask that ppoll, pselect and epoll_pwait have while they wait.
#pragma once

#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <time.h>

#include "libtcs_preload/preemption.h"
#include "libtcs_preload/raw_syscall.h"

namespace tcs::preload {

// For its lifetime all signals are blocked, so that no handler runs where the call would not let
// it; a signal that the mask lets in ends the wait by being pending (WaitForFds), and its handler
// runs under the mask in one step with the end of the wait (Deliver). Without a mask the object
// does nothing.
class MaskedWait {
 public:
  explicit MaskedWait(const sigset_t* mask) : active_(mask != nullptr) {
    if (!active_) return;
    mask_ = *reinterpret_cast<const unsigned long*>(mask);
    const unsigned long all = ~0ul;
    RawSyscall(SYS_rt_sigprocmask, SIG_SETMASK, Arg(&all), Arg(&saved_), kSetSize);
  }
  ~MaskedWait() { Restore(); }
  MaskedWait(const MaskedWait&) = delete;
  MaskedWait& operator=(const MaskedWait&) = delete;

  void Restore() {
    if (active_) RawSyscall(SYS_rt_sigprocmask, SIG_SETMASK, Arg(&saved_), 0, kSetSize);
    active_ = false;
  }

  bool active() const { return active_; }

  // The signals that end the wait.
  unsigned long Awaited() const { return active_ ? ~mask_ & ~kNeverHeld & ~OwnSignals() : 0; }

  bool IsPending() const {
    unsigned long pending = 0;
    if (active_) RawSyscall(SYS_rt_sigpending, Arg(&pending), kSetSize);
    return (pending & Awaited()) != 0;
  }

  // Runs the handlers of pending signals. True if there was one; signals that are ignored are
  // thrown away.
  bool Deliver() const {
    if (!active_) return false;
    const timespec now{};
    const unsigned long mask = mask_ | OwnSignals();
    return RawSyscall(SYS_ppoll, 0, 0, Arg(&now), Arg(&mask), kSetSize) == -EINTR;
  }

 private:
  static constexpr std::size_t kSetSize =
      8;  // the kernel's sigset_t; the C library's begins with it
  static constexpr unsigned long kNeverHeld = 1ul << (SIGKILL - 1) | 1ul << (SIGSTOP - 1);
  bool active_;
  unsigned long mask_ = 0, saved_ = 0;
};

}  // namespace tcs::preload
