// The signal mask that ppoll, pselect and epoll_pwait put in place while they wait.
#pragma once

#include <signal.h>

#include "libtcs_preload/raw_syscall.h"

namespace tcs::preload {

// Sets `mask` (null: none) for its lifetime. Not atomic with the wait, as the kernel's is: a signal
// that the mask lets in is handled at once and ends the wait only if it comes after the wait has
// begun. docs/LIMITATIONS.md says so.
class MaskDuringWait {
 public:
  explicit MaskDuringWait(const sigset_t* mask) : active_(mask != nullptr) {
    if (active_) RawSyscall(SYS_rt_sigprocmask, SIG_SETMASK, Arg(mask), Arg(&saved_), 8);
  }
  ~MaskDuringWait() {
    if (active_) RawSyscall(SYS_rt_sigprocmask, SIG_SETMASK, Arg(&saved_), 0, 8);
  }
  MaskDuringWait(const MaskDuringWait&) = delete;
  MaskDuringWait& operator=(const MaskDuringWait&) = delete;

 private:
  bool active_;
  unsigned long saved_ = 0;
};

}  // namespace tcs::preload
