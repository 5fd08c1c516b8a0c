// What threads ask of their robot's scheduler: policies, priorities, cores; and who is blocked on a
// lock of whom, so that the owner inherits the priority.
#include <errno.h>
#include <limits.h>
#include <sched.h>

#include "coordinator/core/engine.h"
#include "coordinator/core/scheduling_rights.h"

namespace tcs {

namespace {

bool IsValid(int policy, std::int64_t priority) {
  if (IsRealTime(policy)) return priority >= 1 && priority <= 99;
  return (policy == SCHED_OTHER || policy == SCHED_BATCH || policy == SCHED_IDLE) && priority == 0;
}

SchedulingParameters Wanted(const SchedulingParameters& now, std::int64_t policy,
                            std::int64_t priority) {
  const bool keeps = policy == shm::kKeepPolicy;
  return {.policy = keeps ? now.policy : static_cast<int>(policy & ~SCHED_RESET_ON_FORK),
          .priority = static_cast<int>(priority),
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
void Engine::BlockOn(Task& task, Task* owner) {
  task.lock_owner = owner;
  const bool inherits = owner != nullptr && owner->process->robot == task.process->robot;
  SchedulerOf(task).SetBlockedOn(task.order, inherits ? owner->order : RobotScheduler::kNobody);
}

// The task is blocked on nobody any more, who loses what it inherited.
void Engine::LeaveLock(Task& task) {
  const RobotScheduler::Thread owner = SchedulerOf(task).BlockedOn(task.order);
  BlockOn(task, nullptr);
  if (owner != RobotScheduler::kNobody) FindPriority(TaskAt(owner));
}

std::int64_t Engine::MayPrioritize(const Task& asking, const Task& task, std::int64_t policy,
                                   std::int64_t priority) {
  const SchedulingParameters& now = ParametersOf(task);
  const SchedulingParameters wanted = Wanted(now, policy, priority);
  if (policy != shm::kKeepPolicy && (policy < 0 || policy > INT_MAX)) return -EINVAL;
  if (!IsValid(wanted.policy, priority)) return -EINVAL;
  return MaySetScheduling(asking.tid, task.tid, now, wanted) ? 0 : -EPERM;
}

std::int64_t Engine::SetPriority(const Task& asking, Task& task, std::int64_t policy,
                                 std::int64_t priority) {
  if (const std::int64_t error = MayPrioritize(asking, task, policy, priority); error != 0) {
    return error;
  }
  SchedulerOf(task).SetParameters(task.order, Wanted(ParametersOf(task), policy, priority));
  FindPriority(task);
  return 0;
}

std::int64_t Engine::SetAffinity(const Task& asking, Task& task, std::uint64_t cores) {
  if (!MaySetAffinity(asking.tid, task.tid)) return -EPERM;
  return SchedulerOf(task).SetCores(task.order, cores) ? 0 : -EINVAL;
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
