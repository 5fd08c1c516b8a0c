#include "simbody_bridge/simbody/tree/tree_steps.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tcs {
namespace {

constexpr double kSafety = 0.9;  // of the length that the error of the last one promises
constexpr double kMostGrowth = 5, kMostShrinking = 0.1, kLeastShrinking = 0.5;
constexpr double kShortestS = 1e-9;

double Square(double x) { return x * x; }

// In whole nanoseconds, as islands count: the next step then begins where this one ends, and its
// first derivatives are known.
double WholeNanoseconds(double seconds) {
  const auto ns = static_cast<std::int64_t>(seconds * 1e9);
  return ns > 0 ? VirtualDuration::Nanoseconds(ns).seconds() : seconds;
}

}  // namespace

void TreeSteps::Begin(SimbodyTree& tree, IslandStep& step) {
  const std::size_t size = step.from.size();
  step.to.resize(size);
  step.from_rate.resize(size);
  state_.resize(size);
  middle_rate_.resize(size);
  end_rate_.resize(size);
  tree.EvaluateOrRecall(step.from, loads_.At(step, 0), step.from_rate.data());
}

void TreeSteps::Try(SimbodyTree& tree, IslandStep& step, double h) {
  const std::size_t size = step.from.size();
  for (std::size_t k = 0; k < size; ++k) state_[k] = step.from[k] + h / 2 * step.from_rate[k];
  tree.Evaluate(state_, loads_.At(step, h / 2), middle_rate_.data());
  for (std::size_t k = 0; k < size; ++k) {
    state_[k] = step.from[k] + h * (2 * middle_rate_[k] - step.from_rate[k]);
  }
  tree.Evaluate(state_, loads_.At(step, h), end_rate_.data());
  for (std::size_t k = 0; k < size; ++k) {
    step.to[k] = step.from[k] + h / 6 * (step.from_rate[k] + 4 * middle_rate_[k] + end_rate_[k]);
  }
}

// The greatest among the joints, of coordinates or of speeds.
double TreeSteps::ErrorOf(const SimbodyTree& tree, const IslandStep& step, double h) const {
  const auto error = [&](std::size_t i) {
    return step.to[i] - (step.from[i] + h * middle_rate_[i]);
  };
  double greatest = 0, all = 0;
  for (const SimbodyTree::Slots& slots : tree.slots()) {
    double coordinates = 0, speeds = 0;
    for (std::size_t i = slots.q; i < slots.q + slots.q_count; ++i) coordinates += Square(error(i));
    for (std::size_t i = slots.u; i < slots.u + slots.u_count; ++i) {
      speeds += Square(error(i) / std::max(1.0, std::abs(step.from[i])));
    }
    greatest = std::max({greatest, coordinates / static_cast<double>(slots.q_count),
                         speeds / static_cast<double>(slots.u_count)});
    all += coordinates + speeds;
  }
  return std::isfinite(all) ? std::sqrt(greatest) : all;
}

void TreeSteps::TakeControlled(SimbodyTree& tree, IslandStep& step, double limit_s) {
  Begin(tree, step);
  const double most_s = std::min(limit_s, std::max(kShortestS, tree.LongestStepFrom(step.from)));
  bool is_limited = step.try_s > most_s;
  double h = std::min(step.try_s, most_s);
  if (h != step.limit.seconds()) h = WholeNanoseconds(h);
  for (;;) {
    Try(tree, step, h);
    const double error = ErrorOf(tree, step, h);
    const double promised_s = kSafety * h * std::cbrt(accuracy_ / error);  // infinite without error
    if (error <= accuracy_) {
      step.length_s = h;
      // What a limit did not let it try it has no reason to give up, nor to hope for more.
      const double next_s = is_limited ? step.try_s : kMostGrowth * h;
      step.next_try_s = std::clamp(promised_s, h, std::max(h, next_s));
      break;
    }
    is_limited = false;
    h = std::isfinite(error) ? std::clamp(promised_s, kMostShrinking * h, kLeastShrinking * h)
                             : kMostShrinking * h;
    h = WholeNanoseconds(h);
    if (h < kShortestS) throw std::runtime_error("no step is short enough for the accuracy");
  }
  tree.Project(step.to);
  step.to_rate.resize(step.to.size());
  tree.EvaluateOrRecall(step.to, loads_.At(step, step.length_s), step.to_rate.data());
}

void TreeSteps::TakeWhole(SimbodyTree& tree, IslandStep& step) {
  Begin(tree, step);
  step.length_s = step.limit.seconds();
  Try(tree, step, step.length_s);
  tree.Project(step.to);
}

}  // namespace tcs
