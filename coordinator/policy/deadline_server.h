// The absolute deadline of one thread, and the budget that it has until then: a constant bandwidth
// server, by the rules of Linux's SCHED_DEADLINE (Documentation/scheduler/sched-deadline.rst).
//
// A thread that wakes keeps its deadline if what is left of its budget fits into what is left of
// the time, else it begins anew: its deadline is `deadline_ns` later, its budget whole. A thread
// that has used up its budget is throttled until its next period. A thread whose runtime has no end
// has no budget either: every release begins anew.
//
// Pure; virtual nanoseconds.
#pragma once

#include <cstdint>

#include "coordinator/policy/scheduling_parameters.h"

namespace tcs {

class DeadlineServer {
 public:
  // Begins anew, with other parameters.
  void Start(const DeadlineParameters& parameters, std::int64_t now_ns);
  void WakeUp(std::int64_t now_ns);
  // The deadline that the thread would have if it woke at `now_ns`.
  std::int64_t DeadlineIfWoken(std::int64_t now_ns) const;
  // The thread has come to `now_ns` after running for `ns`.
  void Spend(std::int64_t ns, std::int64_t now_ns);
  // The thread wants no more of this period (sched_yield).
  void GiveUp(std::int64_t now_ns);

  const DeadlineParameters& parameters() const { return parameters_; }
  std::int64_t deadline_ns() const { return deadline_ns_; }
  std::int64_t budget_ns() const { return HasBudget() ? budget_ns_ : INT64_MAX; }
  std::int64_t throttled_until_ns() const { return throttled_until_ns_; }

 private:
  bool HasBudget() const { return parameters_.runtime_ns > 0; }
  std::int64_t NextPeriod() const;
  bool Overflows(std::int64_t now_ns) const;

  DeadlineParameters parameters_;
  std::int64_t deadline_ns_ = 0, budget_ns_ = 0;
  std::int64_t throttled_until_ns_ = 0;
};

}  // namespace tcs
