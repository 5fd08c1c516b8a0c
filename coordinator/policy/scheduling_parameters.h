// What a thread has asked its robot's scheduler for, in POSIX's terms.
#pragma once

#include <sched.h>

namespace tcs {

struct SchedulingParameters {
  int policy = SCHED_OTHER;
  int priority = 0;             // of SCHED_FIFO and SCHED_RR: 1 to 99
  bool resets_on_fork = false;  // SCHED_RESET_ON_FORK: what it creates is an ordinary thread

  // As sched_getscheduler says it.
  int PolicyAndFlag() const { return policy | (resets_on_fork ? SCHED_RESET_ON_FORK : 0); }
};

inline bool IsRealTime(int policy) { return policy == SCHED_FIFO || policy == SCHED_RR; }

}  // namespace tcs
