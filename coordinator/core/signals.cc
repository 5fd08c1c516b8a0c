// Signals that clients send to each other. The kernel delivers them; but a thread that waits runs
// its handler only when it is dispatched, and that is to be at the sender's virtual time. So is the
// end of a wait for the signal itself.
#include <signal.h>
#include <x86intrin.h>

#include <algorithm>
#include <utility>

#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"
#include "coordinator/os/signal_bits.h"

namespace tcs {

namespace {

constexpr std::int64_t kLookEveryNs = 10'000'000;  // real time

// What of `pending` makes a thread with these sets run or end. What only stops it does so when it
// runs next.
std::uint64_t Deliverable(std::uint64_t pending, const SignalSets& sets, std::uint64_t blocked) {
  return pending & ~blocked & ~(kStopSignals & ~sets.caught);
}

}  // namespace

// True if the thread waits for a signal that is pending: then it goes on.
bool Engine::EndAwait(Task& task, const SignalSets& sets, Moment moment) {
  const std::uint64_t pending = sets.own_pending | sets.shared_pending;
  if (!task.wait.has_value() || (pending & SignalsThatEnd(*task.wait)) == 0) return false;
  MakeReady(task, shm::WakeReason::kGo, moment);
  return true;
}

// Nobody says that a signal has come from outside, so those who wait for one are looked at now and
// then. True if one goes on.
bool Engine::PollSignals() {
  const bool awaited =
      gates_only_ || wait_counts_.for_signals() > 0 || wait_counts_.for_stops() > 0;
  if (!awaited || __rdtsc() < next_signal_look_tsc_) return false;
  next_signal_look_tsc_ =
      __rdtsc() + static_cast<std::uint64_t>(static_cast<double>(kLookEveryNs) * ticks_per_ns_);
  bool ended = false;
  const std::int64_t now_ns = turn_.lasts() ? WrittenAt() : latest_ns_;
  for (Task& task : table_.tasks()) {
    if (!task.wait.has_value()) continue;
    const Moment moment{std::max(now_ns, task.reached_ns)};
    if (HasSignalForTrapped(task)) {
      WakeForSignals(*task.process, moment);
    } else if (SignalsThatEnd(*task.wait) == 0 || !EndAwait(task, SignalsOf(task), moment)) {
      continue;
    }
    latest_ns_ = moment.ns;
    ended = true;
  }
  LookAtStops({latest_ns_});
  return ended;
}

// Without levels the kernel keeps a signal from a thread whose call is trapped (os/trap.cc), so
// that nobody but who looks learns of one from outside. One from inside is told by who sends it.
bool Engine::HasSignalForTrapped(Task& task) const {
  if (!gates_only_ || turn_.lasts() || !task.wait->is_in_trapped_call) return false;
  const SignalSets sets = SignalsOf(task);
  return Deliverable(sets.own_pending | sets.shared_pending, sets, BlockedOf(task, sets)) != 0;
}

// PollEvents for the running thread, in turns while somebody waits for signals.
bool Engine::PollWhileRunning(Task& task, std::int64_t timeout_ns) {
  while (wait_counts_.for_signals() + wait_counts_.for_stops() > 0 && timeout_ns > kLookEveryNs) {
    if (PollEvents(kLookEveryNs, {}).stops_running) return true;
    if (!turn_.timed_out) return false;
    turn_.timed_out = false;
    if (PollSignals()) return true;
    timeout_ns -= kLookEveryNs;
    host_cpu_.Continue(task);
  }
  return PollEvents(timeout_ns, {}).stops_running;
}

// What is for the whole process goes to the first of its threads that does not block it, as the
// kernel has it.
void Engine::WakeForSignals(Process& process, Moment moment) {
  std::uint64_t taken = 0;
  for (Task& task : table_.tasks()) {
    if (task.process != &process || task.state == TaskState::kDead) continue;
    // A thread that waits may have kept the level of its last dispatch. With a signal it would run
    // before its next one, and lose what its call is to return.
    if (!host_cpu_.active().IsLast(task)) host_cpu_.active().Hold(task);
    const SignalSets sets = SignalsOf(task);
    if (EndAwait(task, sets, moment)) continue;
    const std::uint64_t mine =
        Deliverable(sets.own_pending | (sets.shared_pending & ~taken), sets, BlockedOf(task, sets));
    taken |= mine;
    if (mine == 0) continue;
    if (task.state == TaskState::kWaiting) MakeReady(task, shm::WakeReason::kSignal, moment);
    AnswerAhead(task);
  }
}

// A thread that runs a handler at its next dispatch gets the result of its trapped call now: should
// it run before (while the running thread waits for the disk), the kernel would end the call with
// an error of its own, and the result would be lost.
void Engine::AnswerAhead(Task& task) {
  // Without levels the kernel keeps the signal until the call is answered (os/trap.cc).
  if (gates_only_ || turn_.IsOf(task) || task.trap_id == 0 || task.trap_continues ||
      task.state != TaskState::kReady) {
    return;
  }
  host_cpu_.active().Hold(task);
  if (AnswerTrapped(task.trap_listener, task.trap_id, task.trap_result)) task.handed_lock = 0;
  task.trap_id = 0;
  task.parked = false;
}

void Engine::WakeSignalled(pid_t receiver, Moment moment) {
  for (Process& process : table_.processes()) {
    if (process.dead || (receiver > 0 && process.pid != receiver)) continue;
    WakeForSignals(process, moment);
    NoteStops(process, moment);
    NoteWhetherStopped(process, moment.ns);
  }
}

// Others miss a stopped program that speaks DDS when its leases are over. It is stopped as a whole
// from when a signal that does so is there, though its threads notice one after another.
void Engine::NoteWhetherStopped(const Process& process, std::int64_t at_ns) {
  if (process.dds_number == 0) return;
  bool stopped = false;
  for (Task& task : table_.tasks()) {
    if (task.process != &process || task.state == TaskState::kDead) continue;
    const SignalSets sets = SignalsOf(task);
    const std::uint64_t ignored = sets.blocked | sets.caught;
    stopped |= ThreadState(task.tid) == 'T' ||
               ((sets.own_pending | sets.shared_pending) & kStopSignals & ~ignored) != 0;
  }
  if (stopped) {
    hub_.Stop(process.dds_number, at_ns);
  } else {
    hub_.Continue(process.dds_number, at_ns);
  }
  ShowDeliverersTheirDeadlines();
}

}  // namespace tcs
