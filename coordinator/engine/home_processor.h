// The host's processor on which all threads of a run take turns: claimed for the run alone, or
// shared with other runs that have only gates. And the further processors that the run's world may
// use.
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
  // Why there is no processor; empty if there is one. Waits until a processor is free, if the run
  // is to.
  [[nodiscard]] std::string Take(const RunState& run);
  int cpu() const { return share_.has_value() ? share_->cpu() : claim_.cpu; }

  void UseHelpers(std::vector<int> cpus) { helpers_ = std::move(cpus); }
  const std::vector<int>& helpers() const { return helpers_; }

  // The run is paused: other runs may have its processor. The work of this run meanwhile, for those
  // who watch it, is next to nothing.
  void Lend();
  // False while somebody else has the processor, which is said once.
  bool TakeBack(const std::function<void(const std::string&)>& on_notice);

  // A run with real-time priorities has come to the processor, before which no thread of this run
  // gets to run. Between two steps, so that nothing depends on where threads are. True if this run
  // has moved.
  bool LeaveIfClaimed();

 private:
  CpuClaim claim_;  // either this or share_
  std::optional<CpuShare> share_;
  std::optional<LentCpu> lent_;  // while the run is paused
  bool asks_for_it_ = false;
  std::vector<int> helpers_;
};

}  // namespace tcs
