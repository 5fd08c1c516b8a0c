// Clocks that are read, and sleeps, made raw. Results are the kernel's: negative for an errno.
//
// For the coordinator's thread only.
#pragma once

#include <cstdint>

#include "coordinator/calls/date_calls.h"
#include "coordinator/port/traps.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class SyscallTimes {
 public:
  SyscallTimes(RunState& run, Waker& waker, DateCalls& dates)
      : run_(run), waker_(waker), dates_(dates) {}

  std::int64_t ReadClock(const Task& task, const TrappedCall& call) const;
  std::int64_t Sleep(Task& task, const TrappedCall& call);
  std::int64_t SetClock(Task& task, const TrappedCall& call);
  std::int64_t Adjust(const Task& task, const TrappedCall& call) const;

 private:
  RunState& run_;
  Waker& waker_;
  DateCalls& dates_;
};

}  // namespace tcs
