// Calls to the scheduler that are made without the C library: the robot's scheduler answers them,
// with the errors of the kernel's.
//
// For the coordinator's thread only.
#pragma once

#include <cstdint>

#include "coordinator/calls/scheduling_calls.h"
#include "coordinator/port/traps.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

class SyscallScheduling {
 public:
  SyscallScheduling(RunState& run, SchedulingCalls& calls) : run_(run), calls_(calls) {}

  // The result of the call: negative for an errno.
  std::int64_t Call(Task& task, const TrappedCall& call);
  // The same of getcpu: the robot's core that the thread is on.
  static std::int64_t CoreOf(const Task& task, const TrappedCall& call);

 private:
  std::int64_t SetScheduling(Task& task, Task* of, const TrappedCall& call);
  static std::int64_t GetScheduling(Task& task, Task& of, const TrappedCall& call);
  std::int64_t SetAttributes(Task& task, Task& of, const TrappedCall& call);
  static std::int64_t GetAttributes(Task& task, const Task& of, const TrappedCall& call);

  RunState& run_;
  SchedulingCalls& calls_;
};

}  // namespace tcs
