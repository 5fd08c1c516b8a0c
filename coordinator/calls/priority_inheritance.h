// Who is blocked on a lock of whom, so that the owner runs with the priority of the most urgent
// thread that waits for it. The robot's scheduler reckons with it; this tells it.
//
// For the coordinator's thread only.
#pragma once

#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class PriorityInheritance {
 public:
  PriorityInheritance(RunState& run, Waker& waker) : run_(run), waker_(waker) {}

  // The task waits for a lock of the owner's; null: for nobody's. A thread of another robot
  // inherits no priority: they are computers apart. The owner's priority is to be found after it.
  static void BlockOn(Task& task, const Task* owner);
  // The task is blocked on nobody any more, who loses what it inherited.
  void Leave(Task& task);
  // Whom the thread blocks, or how urgent they are, may have changed.
  void Find(Task& task);

 private:
  RunState& run_;
  Waker& waker_;
};

}  // namespace tcs
