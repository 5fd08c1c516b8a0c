#include "coordinator/tasks/task_table.h"

#include <algorithm>

namespace tcs {

Task& TaskTable::AddTask(pid_t tid) {
  Task* task = nullptr;
  if (ended_tasks_.size() > kKeptAfterEnd) {
    task = ended_tasks_.front();
    ended_tasks_.pop_front();
    const int order = task->order;
    *task = Task{};
    task->order = order;
  } else {
    task = &tasks_.emplace_back();
    task->order = static_cast<int>(tasks_.size() - 1);
  }
  task->tid = tid;
  by_tid_[tid] = task;
  ++living_;
  return *task;
}

Task* TaskTable::Named(const Process& by, pid_t tid) {
  if (by.pid_namespace == 0) return Living(tid);
  for (Task& task : tasks_) {
    if (task.state != TaskState::kDead && task.own_tid == tid &&
        task.process->pid_namespace == by.pid_namespace) {
      return &task;
    }
  }
  return nullptr;
}

Process* TaskTable::NamedProcess(const Process& by, pid_t pid) {
  if (by.pid_namespace == 0) return LivingProcess(pid);
  for (Process& process : processes_) {
    if (!process.dead && process.own_pid == pid && process.pid_namespace == by.pid_namespace) {
      return &process;
    }
  }
  return nullptr;
}

Process& TaskTable::AddProcess(pid_t pid) {
  Process* process = nullptr;
  if (ended_processes_.size() > kKeptAfterEnd) {
    process = ended_processes_.front();
    ended_processes_.pop_front();
    if (is_reaped_(process->pid)) {
      const std::uint32_t index = process->index;
      *process = Process{};
      process->index = index;
    } else {
      ended_processes_.push_back(process);
      process = nullptr;
    }
  }
  if (process == nullptr) {
    process = &processes_.emplace_back();
    process->index = static_cast<std::uint32_t>(processes_.size() - 1);
  }
  process->pid = pid;
  by_pid_[pid] = process;
  return *process;
}

void TaskTable::TaskEnded(Task& task) {
  // The thread's number may be another's already.
  if (Living(task.tid) == &task) by_tid_.erase(task.tid);
  --living_;
  ended_tasks_.push_back(&task);
}

void TaskTable::ProcessEnded(Process& process) {
  if (LivingProcess(process.pid) == &process) by_pid_.erase(process.pid);
}

Task* TaskTable::Living(pid_t tid) const {
  const auto found = by_tid_.find(tid);
  return found == by_tid_.end() ? nullptr : found->second;
}

Process* TaskTable::LivingProcess(pid_t pid) const {
  const auto found = by_pid_.find(pid);
  return found == by_pid_.end() ? nullptr : found->second;
}

std::vector<Task*> TaskTable::ThreadsOf(const Process& process) {
  std::vector<Task*> threads;
  for (Task& task : tasks_) {
    if (task.process != &process || task.state == TaskState::kDead) continue;
    threads.insert(task.tid == process.pid ? threads.begin() : threads.end(), &task);
  }
  return threads;
}

bool TaskTable::HasChild(const Process& parent) const {
  return std::any_of(processes_.begin(), processes_.end(), [&parent](const Process& process) {
    return !process.dead && process.parent == parent.pid;
  });
}

bool TaskTable::IsBroker(pid_t pid) const {
  return std::any_of(processes_.begin(), processes_.end(), [pid](const Process& process) {
    return process.broker != nullptr && process.broker->Is(pid);
  });
}

}  // namespace tcs
