#include "coordinator/policy/deadline_server.h"

#include <algorithm>

namespace tcs {

namespace {

__extension__ using Wide = __int128;  // of products of times

}  // namespace

void DeadlineServer::Start(const DeadlineParameters& parameters, std::int64_t now_ns) {
  parameters_ = parameters;
  deadline_ns_ = now_ns + parameters.deadline_ns;
  budget_ns_ = parameters.runtime_ns;
  throttled_until_ns_ = 0;
}

std::int64_t DeadlineServer::NextPeriod() const {
  return deadline_ns_ - parameters_.deadline_ns + parameters_.period_ns;
}

// Whether what is left of the budget is more, of what is left of the time, than the runtime is of
// the relative deadline.
bool DeadlineServer::Overflows(std::int64_t now_ns) const {
  return static_cast<Wide>(budget_ns_) * parameters_.deadline_ns >
         static_cast<Wide>(deadline_ns_ - now_ns) * parameters_.runtime_ns;
}

void DeadlineServer::WakeUp(std::int64_t now_ns) {
  if (!HasBudget()) return Start(parameters_, now_ns);
  if (now_ns < throttled_until_ns_) return;
  const bool is_constrained = parameters_.deadline_ns < parameters_.period_ns;
  if (is_constrained && now_ns < deadline_ns_) {
    // The thread's next deadline must not come before its next period: the thread gets as much
    // budget as is its due.
    if (!Overflows(now_ns)) return;
    budget_ns_ = static_cast<std::int64_t>(static_cast<Wide>(parameters_.runtime_ns) *
                                           (deadline_ns_ - now_ns) / parameters_.deadline_ns);
  } else if (is_constrained && now_ns < NextPeriod()) {
    const std::int64_t next = NextPeriod();
    Start(parameters_, next);
    throttled_until_ns_ = next;
  } else if (deadline_ns_ <= now_ns || Overflows(now_ns)) {
    Start(parameters_, now_ns);
  }
}

std::int64_t DeadlineServer::DeadlineIfWoken(std::int64_t now_ns) const {
  DeadlineServer woken = *this;
  woken.WakeUp(std::min(now_ns, INT64_MAX - parameters_.deadline_ns));
  return woken.deadline_ns_;
}

void DeadlineServer::Spend(std::int64_t ns, std::int64_t now_ns) {
  if (!HasBudget()) return;
  budget_ns_ -= ns;
  if (budget_ns_ > 0) return;
  throttled_until_ns_ = NextPeriod();
  while (budget_ns_ <= 0) {
    deadline_ns_ += parameters_.period_ns;
    budget_ns_ += parameters_.runtime_ns;
  }
  if (deadline_ns_ < now_ns) Start(parameters_, now_ns);
}

void DeadlineServer::GiveUp(std::int64_t now_ns) {
  if (HasBudget() && throttled_until_ns_ <= now_ns)
    Spend(std::max<std::int64_t>(0, budget_ns_), now_ns);
}

}  // namespace tcs
