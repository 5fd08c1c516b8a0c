// A time in which no handler of the program's runs.
#pragma once

#include <signal.h>

#include <cstddef>

#include "libtcs_preload/preemption.h"
#include "libtcs_preload/raw_syscall.h"

namespace tcs::preload {

// While a thread gets its place, and has not had its first turn. A handler that ran there would
// find no clock but the host's; or, where the thread has its place already, a clock that nobody has
// set yet. All signals wait until the thread is dispatched; natively the thread would have begun
// only then, too.
class WithoutHandlers {
 public:
  WithoutHandlers() {
    const unsigned long all = ~0ul;
    RawSyscall(SYS_rt_sigprocmask, SIG_SETMASK, Arg(&all), Arg(&before_), kSetSize);
  }
  // The own signals of tcs reach every thread that has attached meanwhile.
  ~WithoutHandlers() {
    const unsigned long mask = before_ & ~OwnSignals();
    RawSyscall(SYS_rt_sigprocmask, SIG_SETMASK, Arg(&mask), 0, kSetSize);
  }
  WithoutHandlers(const WithoutHandlers&) = delete;
  WithoutHandlers& operator=(const WithoutHandlers&) = delete;

  // The signals that the thread blocks itself.
  unsigned long before() const { return before_; }

 private:
  static constexpr std::size_t kSetSize = 8;  // the kernel's sigset_t

  unsigned long before_ = 0;
};

}  // namespace tcs::preload
