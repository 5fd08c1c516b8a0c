#include "coordinator/tasks/signal_sets.h"

#include <signal.h>

#include "coordinator/os/signal_bits.h"

namespace tcs {

namespace {

// Signals that do nothing unless they are caught.
constexpr std::uint64_t kDoNothing =
    SignalBit(SIGCHLD) | SignalBit(SIGCONT) | SignalBit(SIGURG) | SignalBit(SIGWINCH);

}  // namespace

std::uint64_t LostOf(const SignalSets& sets) {
  return (sets.ignored | (kDoNothing & ~sets.caught)) & ~sets.blocked;
}

SignalSets SignalsOf(const RunState& run, Task& task) {
  constexpr std::uint64_t kOurs = SignalBit(shm::kPreemptionSignal);
  SignalSets sets = ReadSignalSets(task.tid);
  const bool is_at_gate = task.slot >= 0 && task.parked && task.trap_id == 0;
  if (run.is_unprivileged && is_at_gate) {
    sets.blocked = SlotOf(task).blocked_signals;
    const std::uint64_t lost = LostOf(sets);
    sets.own_pending &= ~lost;
    sets.shared_pending &= ~lost;
  }
  if (!run.SendsToGates()) return sets;
  if ((sets.own_pending & kOurs) == 0) {
    task.has_signal = false;
  } else if (task.has_signal) {
    sets.own_pending &= ~kOurs;
  } else {
    sets.blocked &= ~kOurs;
  }
  return sets;
}

}  // namespace tcs
