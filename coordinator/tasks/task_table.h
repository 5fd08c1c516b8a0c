// The threads and processes of a run, as the coordinator knows them, ended ones among them.
//
// Each thread and each process has a place, by whose number the policies, the records and the
// kernel's events speak of it. The place of an ended one is had again, the earliest first, but not
// before so many others have ended that nobody speaks of the ended one any more. References stay
// valid; the thread or process there may be another one by then. For the coordinator's thread only;
// makes no system call itself.
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

  // The new one's number is set, and nothing else. An older one that lives and has the same number
  // is found by it no longer.
  Task& AddTask(pid_t tid);
  Process& AddProcess(pid_t pid);
  // The thread, or process, lives no longer. The caller says in its fields what else that means.
  void TaskEnded(Task& task);
  void ProcessEnded(Process& process);
  // The place of that process may be had again.
  void GiveUp(Process& ended) { ended_processes_.push_back(&ended); }

  // Threads that live.
  int living() const { return living_; }
  // Null if no living one has that number.
  Task* Living(pid_t tid) const;
  Process* LivingProcess(pid_t pid) const;
  // The same by the numbers that the process `by` says.
  Task* Named(const Process& by, pid_t tid);
  Process* NamedProcess(const Process& by, pid_t pid);
  // A process's threads that live, in the order in which the kernel considers them for a signal:
  // the main thread first, wherever its place is.
  std::vector<Task*> ThreadsOf(const Process& process);
  // Whether that process is the broker of another one (os/descriptor_broker.h).
  bool IsBroker(pid_t pid) const;
  // Whether a child of the process lives.
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
