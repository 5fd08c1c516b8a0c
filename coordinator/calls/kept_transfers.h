// Reads and writes of trapped calls, on the coordinator's copies of their files (kept_calls.h).
//
// For the coordinator's thread only.
#pragma once

#include <cstdint>

#include "coordinator/port/traps.h"
#include "coordinator/tasks/task.h"

namespace tcs {

class KeptTransfers {
 public:
  // The result of the call; -EAGAIN: the call has to wait for more. A socket that the call accepts
  // is task.trap_file.
  static std::int64_t CarryOut(Task& task, const TrappedCall& call);
};

}  // namespace tcs
