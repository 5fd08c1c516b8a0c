// Whether a descriptor of a client's is the last one of its socket: only that one's close lingers
// (SO_LINGER). The clients' processes are all that can have others, as far as /proc tells.
#pragma once

#include "coordinator/port/traps.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/task.h"

namespace tcs {

class LastDescriptor {
 public:
  static bool AsksFor(const TrappedCall& call);
  // `task`: null for no thread of the run.
  static void Answer(const RunState& run, const Task* task, const TrappedCall& call);
};

}  // namespace tcs
