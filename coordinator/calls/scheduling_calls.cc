#include "coordinator/calls/scheduling_calls.h"

#include <errno.h>
#include <limits.h>
#include <sched.h>

#include <algorithm>

#include "coordinator/calls/scheduling_rights.h"
#include "coordinator/port/proc_files.h"

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

void SchedulingCalls::Inherit(Task& task, const Task& creator) {
  SchedulerOf(task).Inherit(task.order, creator.order);
  inheritance_.Find(task);
}

std::int64_t SchedulingCalls::MaySchedule(const Task& asking, const Task& task,
                                          const SchedulingParameters& wanted) {
  if (!IsValid(wanted)) return -EINVAL;
  if (!MaySetScheduling(asking.tid, task.tid, ParametersOf(task), wanted)) return -EPERM;
  if (wanted.policy != SCHED_DEADLINE) return 0;
  if (!SchedulerOf(task).MayRunAnywhere(task.order)) return -EPERM;
  return SchedulerOf(task).Admits(task.order, wanted.deadline) ? 0 : -EBUSY;
}

std::int64_t SchedulingCalls::Schedule(const Task& asking, Task& task,
                                       const SchedulingParameters& wanted) {
  if (const std::int64_t error = MaySchedule(asking, task, wanted); error != 0) return error;
  const VirtualTime now = std::max(asking.reached, task.reached);
  SchedulerOf(task).SetParameters(task.order, wanted, now);
  inheritance_.Find(task);
  if (Waker::IsRunnable(task)) waker_.Requeue(task);
  return 0;
}

std::int64_t SchedulingCalls::MayPrioritize(const Task& asking, const Task& task,
                                            std::int64_t policy, std::int64_t priority) {
  if (policy != shm::kKeepPolicy && (policy < 0 || policy > INT_MAX)) return -EINVAL;
  return MaySchedule(asking, task, Wanted(ParametersOf(task), policy, priority));
}

std::int64_t SchedulingCalls::SetPriority(const Task& asking, Task& task, std::int64_t policy,
                                          std::int64_t priority) {
  if (policy != shm::kKeepPolicy && (policy < 0 || policy > INT_MAX)) return -EINVAL;
  return Schedule(asking, task, Wanted(ParametersOf(task), policy, priority));
}

std::int64_t SchedulingCalls::SetAffinity(const Task& asking, Task& task, std::uint64_t cores) {
  if (!MaySetAffinity(asking.tid, task.tid)) return -EPERM;
  RobotScheduler& scheduler = SchedulerOf(task);
  const std::uint64_t before = scheduler.CoresOf(task.order);
  if (!scheduler.SetCores(task.order, cores)) return -EINVAL;
  // The processor time that the thread was promised was promised of all cores.
  if (ParametersOf(task).policy == SCHED_DEADLINE && !scheduler.MayRunAnywhere(task.order)) {
    scheduler.SetCores(task.order, before);
    return -EBUSY;
  }
  return 0;
}

std::int64_t SchedulingCalls::ErrorForStranger(pid_t tid, std::int64_t policy,
                                               std::int64_t priority) {
  if (tid <= 0 || ThreadState(tid) == 'X') return -ESRCH;
  const bool is_valid = policy == shm::kKeepPolicy || IsValid(Wanted({}, policy, priority));
  return is_valid ? -EPERM : -EINVAL;
}

void SchedulingCalls::Handle(Task& asking, const shm::Notification& note) {
  const auto tid = static_cast<pid_t>(note.args[0]);
  Task* task = tid == 0 ? &asking : run_.table.Named(*asking.process, tid);
  asking.reply[1] = 0;
  if (task == nullptr || task->process->robot != asking.process->robot) {
    const bool sets = note.kind == shm::NotificationKind::kPriority;
    asking.reply[0] = sets ? ErrorForStranger(tid, note.args[1], note.args[2]) : -ESRCH;
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
