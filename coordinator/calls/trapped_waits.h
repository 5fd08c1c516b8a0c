// The results of trapped calls that have waited.
//
// For the coordinator's thread only.
#pragma once

#include "coordinator/calls/futex_words.h"
#include "coordinator/calls/syscall_child_waits.h"
#include "coordinator/tasks/activations.h"
#include "coordinator/tasks/task.h"
#include "shm/layout.h"

namespace tcs {

class TrappedWaits {
 public:
  TrappedWaits(FutexWords& words, SyscallChildWaits& children, Activations& activations)
      : words_(words), children_(children), activations_(activations) {}

  // The call goes on, for that reason; the thread's wait is still there.
  void Finish(Task& task, shm::WakeReason reason);

 private:
  void Interrupt(Task& task);

  FutexWords& words_;
  SyscallChildWaits& children_;
  Activations& activations_;
};

}  // namespace tcs
