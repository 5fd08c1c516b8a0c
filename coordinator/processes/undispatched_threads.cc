#include "coordinator/processes/undispatched_threads.h"

#include <algorithm>
#include <utility>

#include "coordinator/host/host_cpu.h"
#include "coordinator/os/signal_bits.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

namespace {

void Tell(Task& task) {
  if (!std::exchange(task.has_signal, true)) HostCpu::SendToGate(task.process->pid, task);
}

}  // namespace

// Another program has no handler for the signal, and would die of it. Whichever thread executes the
// program becomes its process's first one.
bool UndispatchedThreads::MayBeTold(const Task& task) const {
  if (run_.is_unprivileged || !run_.IsFixed()) return false;
  const Process& process = *task.process;
  const bool may_run = task.slot >= 0 && task.can_be_stopped && !task.is_ahead &&
                       !task.turns_beside && Waker::IsRunnable(task) &&
                       !process.violates_protocol && !process.dead;
  return may_run && std::none_of(process.robot->tasks.begin(), process.robot->tasks.end(),
                                 [&process](const Task* other) {
                                   return other->process == &process && other->executes;
                                 });
}

// A thread that the kernel holds stays in its call: the signal would end the call.
void UndispatchedThreads::TurnEnds(Task& task) {
  if (run_.turn.HasSpoken() || task.parked || !MayBeTold(task)) return;
  if (ThreadState(task.tid) == 'R') Tell(task);
}

// The kernel has the first signal that it delivers decide whether the interrupted call is made
// again. That signal must be the program's: the kernel delivers signals for the thread before those
// for the process, and of these the lowest first.
void UndispatchedThreads::SignalCame(Task& task, const SignalSets& sets) {
  constexpr std::uint64_t kOurs = SignalBit(shm::kPreemptionSignal), kBefore = kOurs - 1;
  const std::uint64_t first = sets.own_pending & sets.caught & ~BlockedOf(task, sets) & kBefore;
  const bool is_second = first != 0 && (sets.caught & kOurs) != 0;
  if (is_second && !run_.turn.IsOf(task) && MayBeTold(task)) Tell(task);
}

bool UndispatchedThreads::WentToGate(Task& task) {
  if (run_.is_unprivileged || SlotOf(task).note.kind != shm::NotificationKind::kPreempted)
    return false;
  if (run_.turn.IsOf(task)) {
    // The thread was on its way there when it was dispatched.
    if (std::exchange(run_.turn.goes_on_from_gate, true)) return false;
    HostCpu::AllowWay(task);
    HostCpu::OpenGate(SlotOf(task));
    return true;
  }
  if (task.parked || task.trap_id != 0 || task.state == TaskState::kUnseen) return false;
  return task.parked = true;
}

}  // namespace tcs
