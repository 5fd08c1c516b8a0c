// The actions that the program has set for its signals.
//
// The kernel hands a call over and has the thread wait for the answer, whatever the call is. A
// signal that comes in that moment would end the call with EINTR where its handler has no
// SA_RESTART, though natively the call never waits and never fails so: glibc ends a program whose
// FUTEX_WAKE returns EINTR. No sender can be kept from it: the kernel sends SIGCHLD, and people
// send SIGINT.
//
// So in the kernel every handler of the program's has SA_RESTART, and all calls are made again. A
// handler of ours comes first, sees in the interrupted context which call that is, and has the call
// fail after all where it would natively: the call waits, and the program wants no restart. The
// program is shown the actions as it has set them.
//
// Handlers that a program sets by raw calls stay as they are. Async-signal-safe; no allocation.
#pragma once

namespace tcs::preload {

// True if a call that a handler interrupted is to be made again: every handler was installed with
// SA_RESTART.
bool RestartsAfterSignal();

}  // namespace tcs::preload
