// Whether a descriptor of a client's is the last one of its socket: only the last one's close
// lingers (SO_LINGER). Only the clients' processes can have other descriptors, as far as /proc
// tells.
#pragma once

#include "coordinator/port/traps.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/task.h"

namespace tcs {

class LastDescriptor {
 public:
  static bool AsksFor(const TrappedCall& call);
  // `task`: null if the caller is no thread of the run.
  static void Answer(const RunState& run, const Task* task, const TrappedCall& call);
};

}  // namespace tcs
