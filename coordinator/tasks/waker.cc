#include "coordinator/tasks/waker.h"

#include <algorithm>
#include <utility>

#include "shm/check.h"

namespace tcs {

bool Waker::IsRunnable(const Task& task) {
  return task.state == TaskState::kReady || task.state == TaskState::kHolding ||
         task.state == TaskState::kStarting;
}

void Waker::SetState(Task& task, TaskState state, bool goes_first) {
  TCS_CHECK(MayFollow(task.state, state));
  TCS_CHECK(task.wait.has_value() == (state == TaskState::kWaiting));
  const bool ends = state == TaskState::kWaiting || state == TaskState::kDead;
  if (ends && task.state != TaskState::kWaiting)
    activations_.Idles(task, state == TaskState::kDead);
  if (state == TaskState::kStarting) activations_.Starts(task);
  if (const int more = (state == TaskState::kUnseen) - (task.state == TaskState::kUnseen);
      more != 0) {
    unseen_ += more;
    ++task.process->changes.turns;  // the thread goes on without a turn
    run_.header->kernel_waiters.store(static_cast<std::uint32_t>(unseen_));
  }
  task.state = state;
  Requeue(task, goes_first);
  // A deliverer that waits for something else must not be waited for: the deliverer may need what
  // its waiters hold.
  if (task.is_deliverer && !IsRunnable(task) && task.Awaits<awaited::Messages>() == nullptr) {
    const bool runs = run_.turn.IsOf(task);
    listeners_.deliverer_is_held_up(*task.process, {runs ? run_.WrittenAt() : task.reached});
  }
}

void Waker::Requeue(Task& task, bool goes_first) {
  if (IsRunnable(task)) {
    SchedulerOf(task).Enqueue(task.order, task.reached, goes_first);
  } else {
    SchedulerOf(task).Dequeue(task.order);
  }
}

void Waker::Refresh(Robot& robot) {
  robot.scheduler.Assign(robot.next_launch);
  for (const VirtualCpu* cpu : robot.cpus) {
    const VirtualTime quiet =
        listeners_.does_nothing_before ? listeners_.does_nothing_before(*cpu) : VirtualTime();
    run_.root.Update(cpu->leaf, cpu->progress, robot.scheduler.NextActionOf(cpu->core), quiet);
  }
}

bool Waker::HasRunOut(const Task& task, VirtualTime now) const {
  if (!task.wait.has_value()) return false;
  if (task.wait->deadline <= now) return true;
  return run_.IsCallback() && OwnDeadlineOf(task) <= task.process->clock.shown();
}

ProgramTime Waker::OwnDeadlineOf(const Task& task) {
  return ProgramClock::At(task.wait->deadline, task.lead);
}

RobotScheduler::Wait Waker::WaitOf(const Task& task) const {
  const Process& process = *task.process;
  RobotScheduler::Wait wait{.process = process.index, .next_expiry = process.timers.NextExpiry()};
  wait.waits = task.wait.has_value() && task.Awaits<awaited::OthersRun>() == nullptr;
  if (!wait.waits) return wait;
  wait.for_input = IsForInput(*task.wait);
  wait.for_thread = task.Awaits<awaited::Futex>() != nullptr;
  wait.from = task.reached;
  wait.until = task.wait->deadline;
  if (run_.IsCallback() && !task.wait->deadline.IsNever()) {
    wait.is_over = HasRunOut(task, VirtualTime());
    wait.own_until = process.clock.RobotTimeOf(OwnDeadlineOf(task));
  }
  return wait;
}

bool Waker::IsSafe(const Task& task) const {
  if (task.state != TaskState::kHolding) return true;
  const VirtualCpu& cpu = *task.cpu;
  return cpu.progress <= (task.hold == shm::NotificationKind::kRead
                              ? run_.root.ReadSafe(cpu.leaf)
                              : run_.root.WriteSafe(cpu.leaf));
}

void Waker::Hold(Task& task, shm::NotificationKind for_what) {
  SetState(task, TaskState::kHolding);
  task.hold = for_what;
}

void Waker::Wait(Task& task, tcs::Wait wait) {
  TCS_CHECK(!task.wait.has_value());
  counts_.Entered(wait);
  ShowObjectWaiters();
  const bool ends_by_signal = SignalsThatEnd(wait) != 0;
  task.wait = std::move(wait);
  SetState(task, TaskState::kWaiting);
  if (ends_by_signal) listeners_.began_by_signal(task);
}

void Waker::Leave(Task& task) {
  std::optional<tcs::Wait> left = std::exchange(task.wait, std::nullopt);
  if (!left.has_value()) return;
  counts_.Left(*left);
  ShowObjectWaiters();
  listeners_.left(task, *left);
}

void Waker::MoveDeadline(Task& task, VirtualTime to) {
  task.wait->deadline = to;
  Requeue(task);
}

// So that threads need not tell of what they do where nobody waits for it.
void Waker::ShowObjectWaiters() {
  const auto waiters = static_cast<std::uint32_t>(counts_.for_objects());
  if (run_.header->object_waiters.load(std::memory_order_relaxed) != waiters) {
    run_.header->object_waiters.store(waiters);
  }
}

// The robot's kernel takes that long to have a thread ready. Waits that a thread natively would not
// make end at once: what DDS by endpoints waits for in place of its library, and spinning.
VirtualDuration Waker::WakeupOf(const Task& task) {
  const WakeupLatency& latency = task.process->robot->wakeup;
  if (latency.IsNone() || !task.wait.has_value()) return {};
  const bool is_ours = task.Awaits<awaited::Deliverer>() != nullptr ||
                       task.Awaits<awaited::Room>() != nullptr ||
                       task.Awaits<awaited::OthersRun>() != nullptr;
  return is_ours ? VirtualDuration() : latency.Of(task.order, task.activations);
}

void Waker::Wake(Task& task, shm::WakeReason reason, EventTime when) {
  if (task.state == TaskState::kDead) return;
  const bool waited = task.wait.has_value(), reads = waited && LooksAtOthers(*task.wait);
  const bool for_messages = task.Awaits<awaited::Messages>() != nullptr;
  const VirtualDuration wakeup = WakeupOf(task);
  const bool outside =
      when.from_outside || (run_.turn.lasts() && !run_.turn.IsOn(*task.process->robot));
  const bool goes_first = outside && waited && SchedulerOf(task).PreemptsOnWakeup(task.order);
  if (outside && reads && !for_messages) NoteLateness(task, when.at, goes_first);
  if (waited) {
    ++task.activations;
    activations_.Released(task, reason, when.at, wakeup);
    task.debt = std::max(VirtualDuration(), task.debt);  // credit ends with the activation
  }
  const VirtualTime seen = std::max({task.reached, when.at, EarliestWake()});
  task.ComeTo(seen + wakeup);
  if (waited) {
    // Where a more urgent thread ran on, the kernel's timer would still have been in time.
    const bool timed = reason == shm::WakeReason::kDeadline;
    const VirtualTime released = timed ? std::min(task.wait->deadline, seen) : seen;
    SchedulerOf(task).WakeUp(task.order, released, outside);
  }
  // Others may have come further: the thread gets a message that is due later than its own time
  // when it is due.
  if (for_messages) {
    const bool is_due = reason == shm::WakeReason::kDeadline;
    task.messages_until = is_due ? task.wait->deadline + wakeup : task.reached;
  }
  if (waited && task.wait->is_in_trapped_call) listeners_.ends_in_trapped_call(task, reason);
  Leave(task);
  // A thread that waited for others looks at what they did: it must see all of that.
  SetState(task, reads && !run_.IsCallback() ? TaskState::kHolding : TaskState::kReady, goes_first);
  task.hold = shm::NotificationKind::kRead;
  task.reason = reason;
  Refresh(*task.process->robot);
}

VirtualTime Waker::EarliestWake() const {
  if (run_.IsCallback()) return {};
  VirtualTime earliest = run_.root.EarliestWake();
  if (run_.turn.lasts()) {
    earliest = std::max(earliest, run_.WrittenAt() - run_.scenario.drift_bound);
  }
  return earliest;
}

void Waker::NoteLateness(const Task& woken, VirtualTime sent, bool goes_first) {
  if (run_.IsCallback()) return;
  sent = std::max(sent, woken.reached);  // the thread has waited since then
  const VirtualDuration late =
      SchedulerOf(woken).LatenessOf(woken.order, sent, EarliestWake(), goes_first);
  run_.report.lateness_ns = std::max(run_.report.lateness_ns, late.ns());
}

}  // namespace tcs
