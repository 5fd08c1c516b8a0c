#include "simbody_bridge/simbody/runge_kutta3.h"

#include <algorithm>

namespace tcs {
namespace {

// The slots of a body among `bodies`.
StateSlots SlotsOf(std::size_t bodies, std::size_t body) {
  return {body * kFreeBodyCoordinates, kFreeBodyCoordinates,
          bodies * kFreeBodyCoordinates + body * kFreeBodySpeeds, kFreeBodySpeeds};
}

}  // namespace

void RungeKutta3::Take(SimbodyRates& rates, std::span<IslandStep* const> steps) {
  Begin(rates, steps);
  while (!open_.empty()) {
    TryOnce(rates);
    std::erase_if(open_, [&](std::size_t i) { return Judge(attempts_[i]); });
  }
  lanes_.clear();
  for (IslandStep* step : steps) {
    NormaliseQuaternions(step->to, static_cast<int>(step->wrenches.size()));
    step->to_rate.resize(step->to.size());
    lanes_.push_back({step, step->length_s, step->to.data(), step->to_rate.data()});
  }
  rates.Evaluate(lanes_);
}

void RungeKutta3::Begin(SimbodyRates& rates, std::span<IslandStep* const> steps) {
  if (attempts_.size() < steps.size()) attempts_.resize(steps.size());
  open_.clear();
  lanes_.clear();
  for (std::size_t i = 0; i < steps.size(); ++i) {
    IslandStep& step = *steps[i];
    const std::size_t size = step.from.size();
    step.to.resize(size);
    step.from_rate.resize(size);
    lanes_.push_back({&step, 0, step.from.data(), step.from_rate.data()});
    Attempt& attempt = attempts_[i];
    attempt.step = &step;
    attempt.length = StepLength(step, step.limit.seconds());
    attempt.state.resize(size);
    attempt.middle_rate.resize(size);
    attempt.end_rate.resize(size);
    open_.push_back(i);
  }
  rates.Evaluate(lanes_);
}

void RungeKutta3::TryOnce(SimbodyRates& rates) {
  lanes_.clear();
  for (const std::size_t index : open_) {
    Attempt& attempt = attempts_[index];
    const double h = attempt.length.seconds();
    KuttaMiddle(*attempt.step, h, &attempt.state);
    lanes_.push_back({attempt.step, h / 2, attempt.state.data(), attempt.middle_rate.data()});
  }
  rates.Evaluate(lanes_);
  lanes_.clear();
  for (const std::size_t index : open_) {
    Attempt& attempt = attempts_[index];
    const double h = attempt.length.seconds();
    KuttaEnd(*attempt.step, attempt.middle_rate, h, &attempt.state);
    lanes_.push_back({attempt.step, h, attempt.state.data(), attempt.end_rate.data()});
  }
  rates.Evaluate(lanes_);
  for (const std::size_t index : open_) {
    Attempt& attempt = attempts_[index];
    KuttaStep(attempt.middle_rate, attempt.end_rate, attempt.length.seconds(), attempt.step);
  }
}

bool RungeKutta3::Judge(Attempt& attempt) const {
  IslandStep& step = *attempt.step;
  const std::size_t bodies = step.wrenches.size();
  const double error = KuttaError(step, attempt.middle_rate, attempt.length.seconds(), bodies,
                                  [bodies](std::size_t body) { return SlotsOf(bodies, body); });
  return attempt.length.Judge(error, accuracy_, &step);
}

}  // namespace tcs
