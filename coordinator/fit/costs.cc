#include "coordinator/fit/costs.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tcs::fit {

namespace {

constexpr double kAllocationPerCall = 2;  // as the costs are unless told
// The misfit of costs in another proportion must be below this share of the usual costs' misfit.
constexpr double kClearlyBetter = 0.98;

struct Unrounded {
  double call_ns = 0, allocation_ns = 0;
};

double Misfit(const Unrounded& costs, const std::vector<Work>& activations) {
  double sum = 0;
  for (const Work& w : activations) {
    sum += std::abs(costs.call_ns * w.calls + costs.allocation_ns * w.allocations - w.charged_ns);
  }
  return sum;
}

// The value below which half of the weights lie; none without values.
std::optional<double> WeightedMedian(std::vector<std::pair<double, double>> values_and_weights) {
  std::sort(values_and_weights.begin(), values_and_weights.end());
  double all = 0, below = 0;
  for (const auto& [value, weight] : values_and_weights) all += weight;
  for (const auto& [value, weight] : values_and_weights) {
    below += weight;
    if (below >= all / 2) return value;
  }
  return {};
}

// The best of the costs that meet the whole charge and are not below 0. `whole` has calls and
// allocations.
Unrounded Best(const Work& whole, const std::vector<Work>& activations) {
  const auto with = [&whole](double allocation_ns) {
    const double rest = whole.charged_ns - allocation_ns * whole.allocations;
    return Unrounded{std::max(0.0, rest / whole.calls), allocation_ns};
  };
  const double allocations_per_call = whole.allocations / whole.calls;
  std::vector<std::pair<double, double>> told;
  for (const Work& w : activations) {
    // With the cost of a call replaced by what the whole charge leaves for it.
    const double more = w.allocations - allocations_per_call * w.calls;
    const double charge = w.charged_ns - whole.charged_ns / whole.calls * w.calls;
    if (more != 0) told.emplace_back(charge / more, std::abs(more));
  }
  const Unrounded usual =
      with(whole.charged_ns / (whole.calls / kAllocationPerCall + whole.allocations));
  const std::optional<double> median = WeightedMedian(std::move(told));
  if (!median.has_value()) return usual;
  const Unrounded best = with(std::clamp(*median, 0.0, whole.charged_ns / whole.allocations));
  const bool is_clear = Misfit(best, activations) < kClearlyBetter * Misfit(usual, activations);
  return is_clear ? best : usual;
}

std::int64_t Whole(double ns) { return static_cast<std::int64_t>(std::llround(ns)); }

// The costs in whole nanoseconds: of the two roundings of the allocation's cost, the one that meets
// the whole charge best.
Costs Rounded(const Unrounded& costs, const Work& whole) {
  Costs best;
  double least = INFINITY;
  const std::int64_t floor_ns = Whole(std::floor(costs.allocation_ns));
  for (const std::int64_t allocation_ns : {floor_ns, floor_ns + 1}) {
    const double rest = whole.charged_ns - static_cast<double>(allocation_ns) * whole.allocations;
    const Costs next{std::max<std::int64_t>(1, Whole(rest / whole.calls)), allocation_ns};
    const double error = std::abs(next.ChargeOf(whole) - whole.charged_ns);
    if (error >= least) continue;
    best = next;
    least = error;
  }
  return best;
}

}  // namespace

double Costs::ChargeOf(const Work& work) const {
  return static_cast<double>(call_ns.value_or(0)) * work.calls +
         static_cast<double>(allocation_ns.value_or(0)) * work.allocations;
}

Costs FitCosts(const Work& whole, const std::vector<Work>& activations) {
  Costs costs;
  if (whole.calls > 0 && whole.allocations > 0) return Rounded(Best(whole, activations), whole);
  if (whole.calls > 0) {
    costs.call_ns = std::max<std::int64_t>(1, Whole(whole.charged_ns / whole.calls));
  }
  if (whole.allocations > 0) costs.allocation_ns = Whole(whole.charged_ns / whole.allocations);
  return costs;
}

double MisfitOf(const Costs& costs, const std::vector<Work>& activations) {
  double charged = 0, wrong = 0;
  for (const Work& w : activations) {
    charged += w.charged_ns;
    wrong += std::abs(costs.ChargeOf(w) - w.charged_ns);
  }
  return charged > 0 ? wrong / charged : 0;
}

}  // namespace tcs::fit
