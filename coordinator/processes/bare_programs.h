// Programs of clients into which the loader preloads no shim: statically linked ones, and those of
// another C library. They are told from others when they begin, before they have read any clock.
//
// For the coordinator's thread only.
#pragma once

#include <sys/types.h>

#include "coordinator/tasks/run_state.h"

namespace tcs {

class BarePrograms {
 public:
  explicit BarePrograms(RunState& run) : run_(run) {}

  // The process has executed a program, which is about to set itself up.
  void Begins(pid_t pid);

 private:
  RunState& run_;
};

}  // namespace tcs
