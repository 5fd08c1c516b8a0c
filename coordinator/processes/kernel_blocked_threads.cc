#include "coordinator/processes/kernel_blocked_threads.h"

#include <sys/types.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "coordinator/port/proc_files.h"

namespace tcs {

void KernelBlockedThreads::LendLevel() {
  std::vector<Task*> own, others;
  for (Task& task : run_.table.tasks()) {
    if (run_.turn.IsOf(task) || task.parked || task.state == TaskState::kDead) continue;
    if (task.is_ahead) continue;  // the thread has a processor
    if (task.may_run || ThreadState(task.tid) != 'R') continue;
    if (IsInUserMode(task.tid)) continue;
    (task.process == run_.turn.task()->process ? own : others).push_back(&task);
  }
  const std::vector<Task*>& able = own.empty() ? others : own;
  if (able.empty()) return;
  cpu_.active().Lend(*able[static_cast<std::size_t>(run_.turn.held_looks) % able.size()]);
}

void KernelBlockedThreads::LetDie(const Process& process) {
  for (Task* task : process.robot->tasks) {
    if (task->process != &process || task->may_run || !IsDying(task->tid)) continue;
    cpu_.active().LetRun(*task);
  }
}

bool KernelBlockedThreads::HasExited(const Task& task) {
  const std::vector<pid_t> threads = ThreadsOf(task.process->pid);
  return std::any_of(threads.begin(), threads.end(),
                     [&](pid_t tid) { return tid != task.tid && !IsDying(tid); });
}

}  // namespace tcs
