// The parameters that a thread has asked its robot's scheduler for, in POSIX's and Linux's terms.
#pragma once

#include <sched.h>

#include <cstdint>

#ifndef SCHED_DEADLINE
#define SCHED_DEADLINE 6  // of <linux/sched.h>
#endif

namespace tcs {

// Of SCHED_DEADLINE: `runtime_ns` of processor time in each period, by `deadline_ns` after the
// period's beginning.
struct DeadlineParameters {
  std::int64_t runtime_ns = 0;  // 0: without end, and no period is kept
  std::int64_t deadline_ns = 0;
  std::int64_t period_ns = 0;
};

struct SchedulingParameters {
  int policy = SCHED_OTHER;
  int priority = 0;             // of SCHED_FIFO and SCHED_RR: 1 to 99
  bool resets_on_fork = false;  // SCHED_RESET_ON_FORK: the thread's new threads are ordinary
  DeadlineParameters deadline{};

  // The policy and the flag, as sched_getscheduler returns them.
  int PolicyAndFlag() const { return policy | (resets_on_fork ? SCHED_RESET_ON_FORK : 0); }
};

inline bool IsRealTime(int policy) { return policy == SCHED_FIFO || policy == SCHED_RR; }

}  // namespace tcs
