#include "simbody_bridge/simbody/runge_kutta3.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tcs {
namespace {

constexpr double kSafety = 0.9;  // of the length that the error of the last one promises
constexpr double kMostGrowth = 5, kMostShrinking = 0.1, kLeastShrinking = 0.5;
constexpr double kShortestS = 1e-9;

double Square(double x) { return x * x; }

// The greatest among the bodies, of coordinates or of speeds.
double ErrorOf(const IslandStep& step, const std::vector<double>& middle_rate, double h) {
  const std::size_t bodies = step.wrenches.size();
  const auto error = [&](std::size_t i) {
    return step.to[i] - (step.from[i] + h * middle_rate[i]);
  };
  double greatest = 0, all = 0;
  for (std::size_t body = 0; body < bodies; ++body) {
    double coordinates = 0, speeds = 0;
    for (std::size_t k = 0; k < kFreeBodyCoordinates; ++k) {
      coordinates += Square(error(body * kFreeBodyCoordinates + k));
    }
    for (std::size_t k = 0; k < kFreeBodySpeeds; ++k) {
      const std::size_t i = bodies * kFreeBodyCoordinates + body * kFreeBodySpeeds + k;
      speeds += Square(error(i) / std::max(1.0, std::abs(step.from[i])));
    }
    greatest = std::max({greatest, coordinates / kFreeBodyCoordinates, speeds / kFreeBodySpeeds});
    all += coordinates + speeds;
  }
  return std::isfinite(all) ? std::sqrt(greatest) : all;
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
    const double limit_s = step.limit.seconds();
    attempt.is_limited = step.try_s > limit_s;
    attempt.length_s = std::min(step.try_s, limit_s);
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
    const IslandStep& step = *attempt.step;
    for (std::size_t k = 0; k < step.from.size(); ++k) {
      attempt.state[k] = step.from[k] + attempt.length_s / 2 * step.from_rate[k];
    }
    lanes_.push_back(
        {&step, attempt.length_s / 2, attempt.state.data(), attempt.middle_rate.data()});
  }
  rates.Evaluate(lanes_);
  lanes_.clear();
  for (const std::size_t index : open_) {
    Attempt& attempt = attempts_[index];
    const IslandStep& step = *attempt.step;
    for (std::size_t k = 0; k < step.from.size(); ++k) {
      attempt.state[k] =
          step.from[k] + attempt.length_s * (2 * attempt.middle_rate[k] - step.from_rate[k]);
    }
    lanes_.push_back({&step, attempt.length_s, attempt.state.data(), attempt.end_rate.data()});
  }
  rates.Evaluate(lanes_);
  for (const std::size_t index : open_) {
    Attempt& attempt = attempts_[index];
    IslandStep& step = *attempt.step;
    for (std::size_t k = 0; k < step.from.size(); ++k) {
      step.to[k] =
          step.from[k] + attempt.length_s / 6 *
                             (step.from_rate[k] + 4 * attempt.middle_rate[k] + attempt.end_rate[k]);
    }
  }
}

// Whether the attempt is good enough; else it is made shorter.
bool RungeKutta3::Judge(Attempt& attempt) const {
  IslandStep& step = *attempt.step;
  const double h = attempt.length_s;
  const double error = ErrorOf(step, attempt.middle_rate, h);
  const double promised_s = kSafety * h * std::cbrt(accuracy_ / error);  // infinite without error
  if (error <= accuracy_) {
    step.length_s = h;
    // What a limit did not let it try it has no reason to give up, nor to hope for more.
    const double most_s = attempt.is_limited ? step.try_s : kMostGrowth * h;
    step.next_try_s = std::clamp(promised_s, h, std::max(h, most_s));
    return true;
  }
  attempt.is_limited = false;
  const bool is_known = std::isfinite(error);
  attempt.length_s = is_known ? std::clamp(promised_s, kMostShrinking * h, kLeastShrinking * h)
                              : kMostShrinking * h;
  if (attempt.length_s < kShortestS) {
    throw std::runtime_error("no step is short enough for the accuracy");
  }
  return false;
}

}  // namespace tcs
