// What threads ask of their robot's scheduler: policies, priorities, cores; and who is blocked on a
// lock of whom, so that the owner inherits the priority.
#include <errno.h>
#include <limits.h>
#include <sched.h>

#include <algorithm>

#include "coordinator/core/engine.h"
#include "coordinator/core/scheduling_rights.h"

namespace tcs {

namespace {

// The kernel's bounds, of sched_deadline_period_min_us and sched_deadline_period_max_us too.
constexpr std::int64_t kLeastRuntimeNs = 1024, kLeastPeriodNs = 100'000,
                       kMostPeriodNs = (std::int64_t{1} << 22) * 1000;

bool IsValid(const DeadlineParameters& wanted) {
  return wanted.runtime_ns >= kLeastRuntimeNs && wanted.deadline_ns >= wanted.runtime_ns &&
         wanted.period_ns >= wanted.deadline_ns && wanted.period_ns >= kLeastPeriodNs &&
         wanted.period_ns <= kMostPeriodNs;
}

bool IsValid(const SchedulingParameters& wanted) {
  if (IsRealTime(wanted.policy)) return wanted.priority >= 1 && wanted.priority <= 99;
  if (wanted.priority != 0) return false;
  if (wanted.policy == SCHED_DEADLINE) return IsValid(wanted.deadline);
  return wanted.policy == SCHED_OTHER || wanted.policy == SCHED_BATCH ||
         wanted.policy == SCHED_IDLE;
}

// As far as sched_setscheduler and sched_setparam can say it; the policy is a valid number.
SchedulingParameters Wanted(const SchedulingParameters& now, std::int64_t policy,
                            std::int64_t priority) {
  const bool keeps = policy == shm::kKeepPolicy;
  return {.policy = keeps ? now.policy : static_cast<int>(policy & ~SCHED_RESET_ON_FORK),
          .priority = static_cast<int>(std::clamp<std::int64_t>(priority, -1, INT_MAX)),
          .resets_on_fork = keeps ? now.resets_on_fork : (policy & SCHED_RESET_ON_FORK) != 0};
}

}  // namespace

void Engine::InheritScheduling(Task& task, const Task& creator) {
  SchedulerOf(task).Inherit(task.order, creator.order);
  FindPriority(task);
}

void Engine::FindPriority(Task& task) {
  if (SchedulerOf(task).FindEffectivePriority(task.order)) Refresh(*task.process->robot);
}

// The task waits for a lock of the owner's. A thread of another robot inherits no priority: they
// are computers apart.
void Engine::BlockOn(Task& task, const Task* owner) {
  if (auto* lock = task.Awaits<awaited::Futex>(); lock != nullptr) {
    lock->owner = owner == nullptr ? awaited::kNobody : owner->order;
  }
  const bool inherits = owner != nullptr && owner->process->robot == task.process->robot;
  SchedulerOf(task).SetBlockedOn(task.order, inherits ? owner->order : RobotScheduler::kNobody);
}

// The task is blocked on nobody any more, who loses what it inherited.
void Engine::LeaveLock(Task& task) {
  const RobotScheduler::Thread owner = SchedulerOf(task).BlockedOn(task.order);
  BlockOn(task, nullptr);
  if (owner != RobotScheduler::kNobody) FindPriority(TaskAt(owner));
}

std::int64_t Engine::MaySchedule(const Task& asking, const Task& task,
                                 const SchedulingParameters& wanted) {
  if (!IsValid(wanted)) return -EINVAL;
  if (!MaySetScheduling(asking.tid, task.tid, ParametersOf(task), wanted)) return -EPERM;
  if (wanted.policy != SCHED_DEADLINE) return 0;
  if (!SchedulerOf(task).MayRunAnywhere(task.order)) return -EPERM;
  return SchedulerOf(task).Admits(task.order, wanted.deadline) ? 0 : -EBUSY;
}

std::int64_t Engine::Schedule(const Task& asking, Task& task, const SchedulingParameters& wanted) {
  if (const std::int64_t error = MaySchedule(asking, task, wanted); error != 0) return error;
  const std::int64_t now = std::max(asking.reached_ns, task.reached_ns);
  SchedulerOf(task).SetParameters(task.order, wanted, now);
  FindPriority(task);
  if (Waker::IsRunnable(task)) waker_.Requeue(task);
  return 0;
}

std::int64_t Engine::MayPrioritize(const Task& asking, const Task& task, std::int64_t policy,
                                   std::int64_t priority) {
  if (policy != shm::kKeepPolicy && (policy < 0 || policy > INT_MAX)) return -EINVAL;
  return MaySchedule(asking, task, Wanted(ParametersOf(task), policy, priority));
}

std::int64_t Engine::SetPriority(const Task& asking, Task& task, std::int64_t policy,
                                 std::int64_t priority) {
  if (policy != shm::kKeepPolicy && (policy < 0 || policy > INT_MAX)) return -EINVAL;
  return Schedule(asking, task, Wanted(ParametersOf(task), policy, priority));
}

std::int64_t Engine::SetAffinity(const Task& asking, Task& task, std::uint64_t cores) {
  if (!MaySetAffinity(asking.tid, task.tid)) return -EPERM;
  RobotScheduler& scheduler = SchedulerOf(task);
  const std::uint64_t before = scheduler.CoresOf(task.order);
  if (!scheduler.SetCores(task.order, cores)) return -EINVAL;
  // What it was promised was promised of all cores.
  if (ParametersOf(task).policy == SCHED_DEADLINE && !scheduler.MayRunAnywhere(task.order)) {
    scheduler.SetCores(task.order, before);
    return -EBUSY;
  }
  return 0;
}

// `tid` as the program knows it.
void Engine::HandleScheduling(Task& asking, const shm::Notification& note) {
  const auto tid = static_cast<pid_t>(note.args[0]);
  Task* task = tid == 0 ? &asking : KnownTask(tid);
  asking.reply[1] = 0;
  if (task == nullptr || task->process->robot != asking.process->robot) {
    asking.reply[0] = -ESRCH;
    return;
  }
  switch (note.kind) {
    case shm::NotificationKind::kPriority:
      asking.reply[0] = note.args[3] != 0 ? MayPrioritize(asking, *task, note.args[1], note.args[2])
                                          : SetPriority(asking, *task, note.args[1], note.args[2]);
      break;
    case shm::NotificationKind::kPriorityGet:
      asking.reply[0] = ParametersOf(*task).PolicyAndFlag();
      asking.reply[1] = ParametersOf(*task).priority;
      break;
    default:
      asking.reply[0] = 0;
      if (note.args[1] != 0) {
        asking.reply[0] = SetAffinity(asking, *task, static_cast<std::uint64_t>(note.args[1]));
      }
      asking.reply[1] = static_cast<std::int64_t>(SchedulerOf(*task).CoresOf(task->order));
  }
}

}  // namespace tcs
