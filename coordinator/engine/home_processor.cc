#include "coordinator/engine/home_processor.h"

#include <utility>
#include <variant>

#include "coordinator/os/guardian.h"

namespace tcs {

std::string HomeProcessor::Take(const RunState& run) {
  if (run.is_unprivileged) {
    share_.emplace();
    return {};
  }
  auto claim = ClaimCpu(run.options.waits_for_cpu);
  if (const auto* taken = std::get_if<std::string>(&claim)) return *taken;
  claim_ = std::move(std::get<CpuClaim>(claim));
  ClientsRunOn(claim_.cpu);
  return {};
}

void HomeProcessor::Lend() {
  if (!lent_.has_value()) lent_.emplace(claim_);
}

bool HomeProcessor::TakeBack(const std::function<void(const std::string&)>& on_notice) {
  if (!lent_.has_value()) return true;
  const bool is_first = !std::exchange(asks_for_it_, true);
  if (lent_->TakeBack()) {
    lent_.reset();
    asks_for_it_ = false;
    return true;
  }
  if (is_first && on_notice) {
    on_notice(lent_->WhoHasIt() +
              "; the run was paused, and goes on when it has its processor again");
  }
  return false;
}

bool HomeProcessor::LeaveIfClaimed() {
  if (!share_.has_value() || !share_->LeaveIfClaimed()) return false;
  std::erase(helpers_, share_->cpu());
  return true;
}

}  // namespace tcs
