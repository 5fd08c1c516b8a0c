// How a thread that computes is stopped where only gates keep threads apart: the coordinator sends
// it kPreemptionSignal, and the handler waits at the gate. A thread that the signal does not reach
// (it has blocked it by a raw call) computes on, with a clock that stands still, and owes what it
// has computed: results are the same.
//
// There the signal interrupts no wait of the program's: threads that wait are not sent it, and
// where a thread has come to a wait meanwhile the signal is blocked until the wait is over.
//
// Under set costs the signal goes to threads with levels, too, whose turn has ended anywhere but at
// their gates, or to whom a signal has come there. Should the processor be free before their next
// turns, they execute nothing of their programs': this signal's handler runs before all others.
#pragma once

#include "libtcs_preload/guest.h"

namespace tcs::preload {

// Has the calling thread stopped by the signal from now on. Called by each thread that attaches:
// the C library has taken the signal for itself when it made its first thread.
void AllowPreemption();

// While this object lives the signal does nothing to the process, not even to the program that the
// process executes meanwhile: until that program has attached, it has no handler, and the signal
// would end it. The kernel keeps ignored signals ignored across execve.
class WithoutPreemption {
 public:
  WithoutPreemption();
  ~WithoutPreemption();
  WithoutPreemption(const WithoutPreemption&) = delete;
  WithoutPreemption& operator=(const WithoutPreemption&) = delete;

 private:
  unsigned long before_[4] = {};  // the action, as the kernel has it
};

// The signals that no program knows of, as the kernel's sigset_t has them.
inline unsigned long OwnSignals() {
  const bool has_one = g_header != nullptr && g_header->preempts != 0;
  return has_one ? 1ul << (shm::kPreemptionSignal - 1) : 0;
}

// The signals of OwnSignals that are blocked while a thread waits. With levels a thread that waits
// has to hear of the own signal: another signal that has ended its wait may have come, and have its
// handler run too early.
inline unsigned long OwnSignalsHeldInWaits() {
  return g_header != nullptr && g_header->is_unprivileged != 0 ? OwnSignals() : 0;
}

}  // namespace tcs::preload
