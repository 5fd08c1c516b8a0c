// What threads ask of their robot's scheduler: policies, priorities, cores; and the priority that a
// thread has from those who wait for a lock that it holds.
#include <errno.h>
#include <sched.h>

#include <algorithm>

#include "coordinator/core/engine.h"

namespace tcs {

namespace {

// What asks for SCHED_FIFO or SCHED_RR precedes all others, what asks for SCHED_IDLE follows them.
constexpr int kRealTimeBand = 1'000'000, kIdleBand = -1'000'000;
constexpr int kMostOwners = 64;  // in a chain of who waits for whom; a circle ends there

int OwnPriority(const Task& task) {
  if (task.policy == SCHED_FIFO || task.policy == SCHED_RR) {
    return kRealTimeBand + task.posix_priority;
  }
  return task.process->priority + (task.policy == SCHED_IDLE ? kIdleBand : 0);
}

bool IsValid(std::int64_t policy, std::int64_t priority) {
  if (policy == SCHED_FIFO || policy == SCHED_RR) return priority >= 1 && priority <= 99;
  return (policy == SCHED_OTHER || policy == SCHED_BATCH || policy == SCHED_IDLE) && priority == 0;
}

std::uint64_t CoresOf(const Task& task) {
  const std::size_t cores = task.process->robot->cpus.size();
  return cores >= 64 ? FixedPriority::kEveryCore : (std::uint64_t{1} << cores) - 1;
}

}  // namespace

void Engine::InheritScheduling(Task& task, const Task& creator) {
  task.policy = creator.policy;
  task.posix_priority = creator.posix_priority;
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

std::int64_t Engine::SetPriority(Task& task, std::int64_t policy, std::int64_t priority) {
  if (!IsValid(policy, priority)) return -EINVAL;
  task.policy = static_cast<int>(policy);
  task.posix_priority = static_cast<int>(priority);
  FindPriority(task);
  return 0;
}

std::int64_t Engine::SetAffinity(Task& task, std::uint64_t cores) {
  if ((cores & CoresOf(task)) == 0) return -EINVAL;
  task.allowed_cores = cores & CoresOf(task);
  if (IsRunnable(task)) Requeue(task);
  return 0;
}

std::uint64_t Engine::AllowedCores(const Task& task) { return task.allowed_cores & CoresOf(task); }

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
      asking.reply[0] = SetPriority(*task, note.args[1], note.args[2]);
      break;
    case shm::NotificationKind::kPriorityGet:
      asking.reply[0] = task->policy;
      asking.reply[1] = task->posix_priority;
      break;
    default:
      asking.reply[0] =
          note.args[1] == 0 ? 0 : SetAffinity(*task, static_cast<std::uint64_t>(note.args[1]));
      asking.reply[1] = static_cast<std::int64_t>(AllowedCores(*task));
  }
}

}  // namespace tcs
