// A system call that a signal's handler has interrupted, as the handler finds it.
//
// Async-signal-safe; no allocation.
#pragma once

#include <ucontext.h>

namespace tcs::preload {

// How a call ends natively when a handler has run while it waited.
enum class EndBySignal {
  kNone,           // the call never waits, or is made again whatever the handler's flags are
  kUnlessRestart,  // with EINTR, unless the handler has SA_RESTART
  kAlways,         // with EINTR
};

class InterruptedCall {
 public:
  explicit InterruptedCall(ucontext_t& context) : registers_(context.uc_mcontext.gregs) {}

  // The kernel makes a call again when the handler returns.
  bool IsMadeAgain() const;
  EndBySignal HowItEnds() const;
  // The call is one of those of HowItEnds that wait for the coordinator's answer instead of the
  // kernel (coordinator/os/trap.cc).
  bool IsHandedOver() const;
  void FailWithEintr();

 private:
  greg_t* registers_;
};

}  // namespace tcs::preload
