// What a trapped call returns that has waited.
//
// For the coordinator's thread only.
#pragma once

#include "coordinator/core/activations.h"
#include "coordinator/core/futex_words.h"
#include "coordinator/core/raw_child_waits.h"
#include "coordinator/core/task.h"
#include "shm/layout.h"

namespace tcs {

class TrappedWaits {
 public:
  TrappedWaits(FutexWords& words, RawChildWaits& children, Activations& activations)
      : words_(words), children_(children), activations_(activations) {}

  // The call goes on, for that reason; the thread's wait is still there.
  void Finish(Task& task, shm::WakeReason reason);

 private:
  void Interrupt(Task& task);

  FutexWords& words_;
  RawChildWaits& children_;
  Activations& activations_;
};

}  // namespace tcs
