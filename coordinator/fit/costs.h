// The costs per call and per allocation with which fixed accounting charges what was measured.
// Pure.
//
// Of one client, with a for the cost of a call and b for that of an allocation:
//   a * calls + b * allocations = charged    for the whole run, exactly but for rounding;
//   sum |a * calls_i + b * allocations_i - charged_i|    over its activations i is least.
// The first leaves one unknown, so that the second is a weighted median: no activation that lasted
// long by chance (a page fault, an interrupt) outweighs the others, as it would with squares. Where
// the activations say next to nothing about which of the two it is, because calls and allocations
// go together in all of them, an allocation costs twice a call, as it does unless told.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace tcs::fit {

// The work of an activation, or of a client's whole run. No value is negative.
struct Work {
  double charged_ns = 0;  // virtual processor time
  double calls = 0, allocations = 0;
};

// The costs that the scenario is to state. A cost is none where the run had no calls, or no
// allocations, that it could be of.
struct Costs {
  std::optional<std::int64_t> call_ns;        // 1 or more
  std::optional<std::int64_t> allocation_ns;  // 0 or more

  // The charge that fixed accounting makes for `work`.
  [[nodiscard]] double ChargeOf(const Work& work) const;
};

// `whole` is the work of the whole run, which may be more than the `activations` tell of.
[[nodiscard]] Costs FitCosts(const Work& whole, const std::vector<Work>& activations);

// The share of the activations' charges that `costs` put into the wrong activations, or into none:
// 0 where each charge is met. 0 without activations.
[[nodiscard]] double MisfitOf(const Costs& costs, const std::vector<Work>& activations);

}  // namespace tcs::fit
