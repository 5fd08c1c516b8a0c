#include "coordinator/calls/signal_calls.h"

#include <algorithm>
#include <utility>

#include "coordinator/port/clocks.h"
#include "coordinator/tasks/signal_sets.h"

namespace tcs {

bool SignalCalls::Poll() {
  const bool awaited =
      run_.is_unprivileged || waker_.counts().for_signals() > 0 || waker_.counts().for_stops() > 0;
  // The call in which the kernel holds a thread may make the kernel send a signal: to the holder of
  // a lease, say, for whom the thread waits.
  const bool is_held_anew = waker_.unseen() > std::exchange(unseen_, waker_.unseen());
  if (!awaited || (HostTsc() < next_look_tsc_ && !is_held_anew)) return false;
  next_look_tsc_ = HostTsc() + clock_.TicksIn(kLookEvery.ns());
  bool ended = false;
  const VirtualTime now = run_.turn.lasts() ? run_.WrittenAt() : run_.latest;
  for (Task& task : run_.table.tasks()) {
    if (!task.wait.has_value()) continue;
    const EventTime when{std::max(now, task.reached)};
    if (wakes_.HasSignalForTrapped(task)) {
      wakes_.WakeForSignals(*task.process, when);
    } else if (SignalsThatEnd(*task.wait) == 0 ||
               !wakes_.EndAwait(task, SignalsOf(run_, task), when)) {
      continue;
    }
    run_.latest = when.at;
    ended = true;
  }
  stops_.LookAtAwaited({run_.latest});
  return ended;
}

void SignalCalls::Sent(const SentSignal& signal, EventTime when) {
  if (signal.is_to_itself && !signal.MayStop()) return;
  for (Process& process : run_.table.processes()) {
    if (process.dead || (signal.pid > 0 && process.pid != signal.pid)) continue;
    wakes_.WakeForSignal(process, signal, when);
    if (!signal.MayStop()) continue;
    stops_.Look(process, when);
    looked_at_(process, when.at);
  }
}

}  // namespace tcs
