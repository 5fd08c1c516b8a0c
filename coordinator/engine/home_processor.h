// The host's processor on which all of a run takes turns: claimed for it alone, or shared with
// other runs that have only gates. And the further ones that its world may use.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/os/cpu_claim.h"
#include "coordinator/os/cpu_share.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

class HomeProcessor {
 public:
  // Why there is none; empty if there is one. Waits until one is free, if the run is to.
  [[nodiscard]] std::string Take(const RunState& run);
  int cpu() const { return share_.has_value() ? share_->cpu() : claim_.cpu; }

  void UseHelpers(std::vector<int> cpus) { helpers_ = std::move(cpus); }
  const std::vector<int>& helpers() const { return helpers_; }

  // The run is paused: others may have its processor. What this one does meanwhile, for those who
  // watch it, is next to nothing.
  void Lend();
  // False while somebody else has it, which is said once.
  bool TakeBack(const std::function<void(const std::string&)>& on_notice);

  // A run with real-time priorities has come there, before which nobody of this one runs. Between
  // two steps, so that nothing depends on where threads are. True if the run has moved.
  bool LeaveIfClaimed();

 private:
  CpuClaim claim_;  // one of the two
  std::optional<CpuShare> share_;
  std::optional<LentCpu> lent_;  // while the run is paused
  bool asks_for_it_ = false;
  std::vector<int> helpers_;
};

}  // namespace tcs
