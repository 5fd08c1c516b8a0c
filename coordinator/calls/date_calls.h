// Programs that set the date of their computer (CLOCK_REALTIME), as `date` or a time daemon does.
// Waits and timers that end at a date move with it; waits and timers that were given as a time from
// now on do not.
//
// For the coordinator's thread only.
#pragma once

#include <cstdint>

#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class DateCalls {
 public:
  DateCalls(RunState& run, Waker& waker) : run_(run), waker_(waker) {}

  // The thread's clock shows `date_ns` from now on. 0, or the negative errno: the thread may not,
  // or the run has other robots, who would see the date change in a moment that is not theirs.
  std::int64_t Set(Task& task, std::int64_t date_ns);

 private:
  RunState& run_;
  Waker& waker_;
};

}  // namespace tcs
