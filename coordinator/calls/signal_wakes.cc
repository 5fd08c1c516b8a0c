#include "coordinator/calls/signal_wakes.h"

#include "coordinator/os/signal_bits.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/port/traps.h"
#include "coordinator/tasks/signal_sets.h"

namespace tcs {

namespace {

// The signals of `pending` that make a thread with these sets run or end. A signal that only stops
// the thread does so when the thread runs next.
std::uint64_t Deliverable(std::uint64_t pending, const SignalSets& sets, std::uint64_t blocked) {
  return pending & ~blocked & ~(kStopSignals & ~sets.caught);
}

}  // namespace

bool SignalWakes::EndAwait(Task& task, const SignalSets& sets, EventTime when) {
  const std::uint64_t pending = sets.own_pending | sets.shared_pending;
  if (!task.wait.has_value() || (pending & SignalsThatEnd(*task.wait)) == 0) return false;
  waker_.Wake(task, shm::WakeReason::kGo, when);
  return true;
}

// A thread that waits may have kept the level of its last dispatch. With a signal it would run
// before its next dispatch, and lose what its call is to return.
void SignalWakes::HoldUntilDispatched(Task& task) {
  if (!active_.IsLast(task)) active_.Hold(task);
}

void SignalWakes::WakeFor(Task& task, const SignalSets& sets, std::uint64_t* taken,
                          EventTime when) {
  if (EndAwait(task, sets, when)) return;
  const std::uint64_t blocked = BlockedOf(task, sets);
  const std::uint64_t own = Deliverable(sets.own_pending, sets, blocked);
  std::uint64_t shared = Deliverable(sets.shared_pending & ~*taken, sets, blocked);
  if (shared != 0 && !IsMarkedForSignal(task.tid)) shared = 0;
  *taken |= shared;
  if ((own | shared) == 0) return;
  if (task.state == TaskState::kWaiting) waker_.Wake(task, shm::WakeReason::kSignal, when);
  AnswerAhead(task);
  undispatched_.SignalCame(task, sets);
}

void SignalWakes::WakeForSignals(Process& process, EventTime when) {
  looked_at_ = when;
  std::uint64_t taken = 0;
  for (Task* task : run_.table.ThreadsOf(process)) {
    HoldUntilDispatched(*task);
    WakeFor(*task, SignalsOf(run_, *task), &taken, when);
  }
}

void SignalWakes::WakeForSignal(Process& process, const SentSignal& sent, EventTime when) {
  Task* receiver = sent.tid == 0 ? nullptr : run_.table.Living(sent.tid);
  const bool is_known = sent.number > 0 && (sent.tid == 0 || receiver != nullptr) &&
                        waker_.counts().for_signals() == 0;
  if (!is_known) return WakeForSignals(process, when);
  looked_at_ = when;
  const std::uint64_t bit = SignalBit(sent.number);
  std::uint64_t taken = 0;
  const std::vector<Task*> threads =
      receiver != nullptr ? std::vector<Task*>{receiver} : run_.table.ThreadsOf(process);
  for (Task* task : threads) HoldUntilDispatched(*task);
  for (Task* task : threads) {
    const SignalSets sets = SignalsOf(run_, *task);
    if ((sets.caught & bit) == 0) return WakeForSignals(process, when);  // may end the process
    WakeFor(*task, sets, &taken, when);
    const bool is_there_to_take = (sets.shared_pending & ~taken & bit) != 0;
    if (receiver != nullptr || !is_there_to_take) return;
  }
}

// A thread that runs a handler at its next dispatch gets the result of its trapped call now: should
// it run before (while the running thread waits for the disk), the kernel would end the call with
// an error of its own, and the result would be lost. Where a signal ends the call, that error is
// the result.
void SignalWakes::AnswerAhead(Task& task) {
  // Without levels the kernel keeps the signal until the call is answered (os/trap.cc).
  if (run_.is_unprivileged || run_.turn.IsOf(task) || task.trap_id == 0 || task.trap_continues ||
      task.state != TaskState::kReady || EndsBySignal(task.trap_result)) {
    return;
  }
  active_.Hold(task);
  task.WasAnswered(AnswerTrapped(task.trap_listener, task.trap_id, task.trap_result));
  task.parked = false;
}

bool SignalWakes::HasSignalForTrapped(Task& task) const {
  if (!run_.is_unprivileged || run_.turn.lasts() || !task.wait->is_in_trapped_call) return false;
  const SignalSets sets = SignalsOf(run_, task);
  return Deliverable(sets.own_pending | sets.shared_pending, sets, BlockedOf(task, sets)) != 0 &&
         IsMarkedForSignal(task.tid);
}

}  // namespace tcs
