// setrlimit, getrlimit and prlimit of processor time (RLIMIT_CPU), which the C library's functions
// of these names come to, too. Results are the kernel's: negative for an errno.
//
// For the coordinator's thread only.
#pragma once

#include <cstdint>

#include "coordinator/port/traps.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

class SyscallLimits {
 public:
  explicit SyscallLimits(RunState& run) : run_(run) {}

  std::int64_t Call(Task& task, const TrappedCall& call) const;

 private:
  RunState& run_;
};

}  // namespace tcs
