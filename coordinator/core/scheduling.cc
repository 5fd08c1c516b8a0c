// What threads ask of their robot's scheduler: policies, priorities, cores; and the priority that a
// thread has from those who wait for a lock that it holds.
#include <errno.h>
#include <limits.h>
#include <sched.h>

#include <algorithm>

#include "coordinator/core/engine.h"
#include "coordinator/core/scheduling_rights.h"

namespace tcs {

namespace {

// What asks for SCHED_FIFO or SCHED_RR precedes all others, what asks for SCHED_IDLE follows them.
constexpr int kRealTimeBand = 1'000'000, kIdleBand = -1'000'000;
constexpr int kMostOwners = 64;  // in a chain of who waits for whom; a circle ends there

bool IsRealTime(std::int64_t policy) { return policy == SCHED_FIFO || policy == SCHED_RR; }

int OwnPriority(const Task& task) {
  if (IsRealTime(task.policy)) {
    return kRealTimeBand + task.posix_priority;
  }
  return task.process->priority + (task.policy == SCHED_IDLE ? kIdleBand : 0);
}

bool IsValid(std::int64_t policy, std::int64_t priority) {
  if (IsRealTime(policy)) return priority >= 1 && priority <= 99;
  return (policy == SCHED_OTHER || policy == SCHED_BATCH || policy == SCHED_IDLE) && priority == 0;
}

SchedulingParameters Wanted(const Task& task, std::int64_t policy, std::int64_t priority) {
  const bool keeps = policy == shm::kKeepPolicy;
  return {.policy = keeps ? task.policy : static_cast<int>(policy & ~SCHED_RESET_ON_FORK),
          .priority = static_cast<int>(priority),
          .resets_on_fork = keeps ? task.resets_on_fork : (policy & SCHED_RESET_ON_FORK) != 0};
}

std::uint64_t CoresOf(const Task& task) {
  const std::size_t cores = task.process->robot->cpus.size();
  return cores >= 64 ? FixedPriority::kEveryCore : (std::uint64_t{1} << cores) - 1;
}

}  // namespace

void Engine::InheritScheduling(Task& task, const Task& creator) {
  const bool starts_anew = creator.resets_on_fork && IsRealTime(creator.policy);
  task.policy = starts_anew ? SCHED_OTHER : creator.policy;
  task.posix_priority = starts_anew ? 0 : creator.posix_priority;
  task.allowed_cores = creator.allowed_cores;
  FindPriority(task);
}

// Those who wait for its locks, or for it to deliver, lend it theirs, and it lends to whom it waits
// for.
void Engine::FindPriority(Task& task) {
  Task* next = &task;
  for (int i = 0; next != nullptr && i < kMostOwners; ++i) {
    int priority = OwnPriority(*next);
    for (const Task& waiter : tasks_) {
      const bool lends = waiter.lock_owner == next ||
                         (waiter.waits_for_deliverer && waiter.process->deliverer == next);
      if (lends) priority = std::max(priority, waiter.priority);
    }
    if (priority != next->priority) {
      next->priority = priority;
      next->process->robot->ready.SetPriority(next->order, priority);
      Refresh(*next->process->robot);
    }
    next = next->lock_owner;
  }
}

// It waits no longer for a lock, and takes back what it lent.
void Engine::LeaveLock(Task& task) {
  Task* owner = task.lock_owner;
  task.lock_owner = nullptr;
  if (owner != nullptr) FindPriority(*owner);
}

std::int64_t Engine::MayPrioritize(const Task& asking, const Task& task, std::int64_t policy,
                                   std::int64_t priority) {
  const SchedulingParameters wanted = Wanted(task, policy, priority);
  if (policy != shm::kKeepPolicy && (policy < 0 || policy > INT_MAX)) return -EINVAL;
  if (!IsValid(wanted.policy, priority)) return -EINVAL;
  const SchedulingParameters now{task.policy, task.posix_priority, task.resets_on_fork};
  return MaySetScheduling(asking.tid, task.tid, now, wanted) ? 0 : -EPERM;
}

std::int64_t Engine::SetPriority(const Task& asking, Task& task, std::int64_t policy,
                                 std::int64_t priority) {
  if (const std::int64_t error = MayPrioritize(asking, task, policy, priority); error != 0) {
    return error;
  }
  const SchedulingParameters wanted = Wanted(task, policy, priority);
  task.policy = wanted.policy;
  task.posix_priority = wanted.priority;
  task.resets_on_fork = wanted.resets_on_fork;
  FindPriority(task);
  return 0;
}

std::int64_t Engine::SetAffinity(const Task& asking, Task& task, std::uint64_t cores) {
  if (!MaySetAffinity(asking.tid, task.tid)) return -EPERM;
  if ((cores & CoresOf(task)) == 0) return -EINVAL;
  task.allowed_cores = cores & CoresOf(task);
  if (IsRunnable(task)) Requeue(task);
  return 0;
}

std::uint64_t Engine::AllowedCores(const Task& task) { return task.allowed_cores & CoresOf(task); }

// As sched_getscheduler says it.
int Engine::PolicyOf(const Task& task) {
  return task.policy | (task.resets_on_fork ? SCHED_RESET_ON_FORK : 0);
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
      asking.reply[0] = PolicyOf(*task);
      asking.reply[1] = task->posix_priority;
      break;
    default:
      asking.reply[0] = 0;
      if (note.args[1] != 0) {
        asking.reply[0] = SetAffinity(asking, *task, static_cast<std::uint64_t>(note.args[1]));
      }
      asking.reply[1] = static_cast<std::int64_t>(AllowedCores(*task));
  }
}

}  // namespace tcs
