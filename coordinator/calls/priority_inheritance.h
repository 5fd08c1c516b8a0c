// Which thread is blocked on which owner's lock, so that the owner runs with the priority of the
// most urgent thread that waits for it. The robot's scheduler applies the priority; this class
// tells the scheduler.
//
// For the coordinator's thread only.
#pragma once

#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class PriorityInheritance {
 public:
  PriorityInheritance(RunState& run, Waker& waker) : run_(run), waker_(waker) {}

  // The task waits for a lock of the owner's; null: the lock has no owner. A thread of another
  // robot inherits no priority, because it runs on another computer. The caller then has the
  // owner's priority found.
  static void BlockOn(Task& task, const Task* owner);
  // The task is not blocked on a thread any more, and that thread loses the priority that it
  // inherited.
  void Leave(Task& task);
  // The threads that this thread blocks, or how urgent they are, may have changed.
  void Find(Task& task);

 private:
  RunState& run_;
  Waker& waker_;
};

}  // namespace tcs
