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

// Of an activation, or of a client's whole run. None is negative.
struct Work {
  double charged_ns = 0;  // virtual processor time
  double calls = 0, allocations = 0;
};

// What the scenario is to say. None where the run had nothing that such a cost could be of.
struct Costs {
  std::optional<std::int64_t> call_ns;        // 1 or more
  std::optional<std::int64_t> allocation_ns;  // 0 or more

  // What fixed accounting charges for it.
  [[nodiscard]] double ChargeOf(const Work& work) const;
};

// `whole` is of the whole run, in which there may be more than the `activations` tell of.
[[nodiscard]] Costs FitCosts(const Work& whole, const std::vector<Work>& activations);

// The share of what the activations were charged that `costs` put into the wrong ones, or into
// none: 0 where each is met. 0 for none.
[[nodiscard]] double MisfitOf(const Costs& costs, const std::vector<Work>& activations);

}  // namespace tcs::fit
