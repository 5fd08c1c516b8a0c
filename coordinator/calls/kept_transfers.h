// What a trapped call reads or writes, on the coordinator's copy of its file (kept_calls.h).
//
// For the coordinator's thread only.
#pragma once

#include <cstdint>

#include "coordinator/port/traps.h"
#include "coordinator/tasks/task.h"

namespace tcs {

class KeptTransfers {
 public:
  // What the call returns; -EAGAIN: it has to wait for more. What it accepts is task.trap_file.
  static std::int64_t CarryOut(Task& task, const TrappedCall& call);
};

}  // namespace tcs
