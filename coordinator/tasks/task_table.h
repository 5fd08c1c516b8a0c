// The threads and processes of a run, as the coordinator knows them, those that have ended among
// them.
//
// Each has a place, by whose number the policies, the records and the kernel's events speak of it.
// Of those that have ended a place is had again, the earliest first, but not before so many others
// have ended that nobody speaks of it any more. References stay valid; what they refer to may be
// another one by then. For the coordinator's thread only; makes no system call itself.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "coordinator/tasks/task.h"

namespace tcs {

class TaskTable {
 public:
  static constexpr std::size_t kKeptAfterEnd = 64;

  // `is_reaped` says whether the kernel has given a process's number back: until then its place is
  // its own.
  explicit TaskTable(std::function<bool(pid_t)> is_reaped) : is_reaped_(std::move(is_reaped)) {}

  // Their numbers are set, and nothing else. One that lives and has the same number is found by it
  // no longer.
  Task& AddTask(pid_t tid);
  Process& AddProcess(pid_t pid);
  // It lives no longer. What else that means is said in its fields, by the caller.
  void TaskEnded(Task& task);
  void ProcessEnded(Process& process);
  // That place may be had again.
  void GiveUp(Process& ended) { ended_processes_.push_back(&ended); }

  // Threads that live.
  int living() const { return living_; }
  // Null if none that lives has that number.
  Task* Living(pid_t tid) const;
  Process* LivingProcess(pid_t pid) const;
  // The same by the numbers that a process says.
  Task* Named(const Process& by, pid_t tid);
  Process* NamedProcess(const Process& by, pid_t pid);
  // A process's threads that live, in the order in which the kernel considers them for a signal:
  // the main thread first, wherever its place is.
  std::vector<Task*> ThreadsOf(const Process& process);
  // It is the broker of one (os/descriptor_broker.h).
  bool IsBroker(pid_t pid) const;
  // One of its children lives.
  bool HasChild(const Process& parent) const;

  const Task& At(int order) const { return tasks_[static_cast<std::size_t>(order)]; }
  Task& At(int order) { return tasks_[static_cast<std::size_t>(order)]; }
  Process& ProcessAt(std::uint32_t index) { return processes_[index]; }
  std::deque<Task>& tasks() { return tasks_; }
  const std::deque<Task>& tasks() const { return tasks_; }
  std::deque<Process>& processes() { return processes_; }
  const std::deque<Process>& processes() const { return processes_; }

 private:
  std::function<bool(pid_t)> is_reaped_;
  std::deque<Task> tasks_;
  std::deque<Process> processes_;
  int living_ = 0;
  std::unordered_map<pid_t, Task*> by_tid_;  // the living
  std::unordered_map<pid_t, Process*> by_pid_;
  std::deque<Task*> ended_tasks_;  // whose places can be had again, the earliest first
  std::deque<Process*> ended_processes_;
};

}  // namespace tcs
