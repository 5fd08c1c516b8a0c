#include "coordinator/engine/unseen_threads.h"

#include <algorithm>
#include <vector>

#include "coordinator/engine/wiring.h"
#include "coordinator/port/proc_files.h"

namespace tcs {

void UnseenThreads::ComeBack(Task& task, EventTime when) {
  all_.outside.CallReturns(task, when.at);
  all_.waker.Wake(task, shm::WakeReason::kGo, when);
}

// A thread that blocked where the shim could not see it is runnable again once the kernel says so.
void UnseenThreads::Poll() {
  all_.signals.Poll();
  if (all_.waker.unseen() == 0) return;
  for (Task& task : run_.table.tasks()) {
    if (task.state != TaskState::kUnseen || ThreadState(task.tid) != 'R') continue;
    run_.latest = std::max(run_.latest, task.reached);
    ComeBack(task, {run_.latest});
    task.parked = false;
    all_.dds.NoteWhetherStopped(*task.process, run_.latest);
  }
}

bool UnseenThreads::UnregisteredRun() {
  std::erase_if(run_.exiting, [](pid_t tid) { return !IsExiting(tid); });
  return !run_.exiting.empty() || all_.unregistered.AnyRuns() ||
         all_.unregistered_children.AnyRuns();
}

}  // namespace tcs
