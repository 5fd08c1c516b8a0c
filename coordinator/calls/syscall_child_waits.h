// wait4 and waitid, made raw.
//
// For the coordinator's thread only.
#pragma once

#include "coordinator/port/traps.h"
#include "coordinator/processes/unregistered_children.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class SyscallChildWaits {
 public:
  SyscallChildWaits(RunState& run, Waker& waker, UnregisteredChildren& unregistered)
      : run_(run), waker_(waker), unregistered_(unregistered) {}

  // The thread waits, or the kernel has what the call asks for and carries it out.
  void Await(Task& task, const TrappedCall& call);
  // The kernel is about to tell the parent of its children's stops.
  void ForgetNews(const Process& parent);

 private:
  RunState& run_;
  Waker& waker_;
  UnregisteredChildren& unregistered_;
};

}  // namespace tcs
