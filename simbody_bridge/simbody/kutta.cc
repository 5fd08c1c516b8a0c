#include "simbody_bridge/simbody/kutta.h"

#include <algorithm>
#include <stdexcept>

namespace tcs {
namespace {

constexpr double kSafety = 0.9;  // of the length that the last error promises
constexpr double kMostGrowth = 5, kMostShrinking = 0.1, kLeastShrinking = 0.5;

}  // namespace

void KuttaMiddle(const IslandStep& step, double h, std::vector<double>* state) {
  for (std::size_t k = 0; k < step.from.size(); ++k) {
    (*state)[k] = step.from[k] + h / 2 * step.from_rate[k];
  }
}

void KuttaEnd(const IslandStep& step, const std::vector<double>& middle_rate, double h,
              std::vector<double>* state) {
  for (std::size_t k = 0; k < step.from.size(); ++k) {
    (*state)[k] = step.from[k] + h * (2 * middle_rate[k] - step.from_rate[k]);
  }
}

void KuttaStep(const std::vector<double>& middle_rate, const std::vector<double>& end_rate,
               double h, IslandStep* step) {
  for (std::size_t k = 0; k < step->from.size(); ++k) {
    step->to[k] = step->from[k] + h / 6 * (step->from_rate[k] + 4 * middle_rate[k] + end_rate[k]);
  }
}

bool StepLength::Judge(double error, double accuracy, IslandStep* step) {
  const double h = seconds_;
  const double promised_s = kSafety * h * std::cbrt(accuracy / error);  // infinite without error
  if (error <= accuracy) {
    step->length_s = h;
    // Error control has no reason to give up a length that a limit did not let it try, nor to hope
    // for more.
    const bool is_limited = is_limited_ || is_cut_;
    const double most_s = is_limited ? std::min(step->try_s, failed_s_) : kMostGrowth * h;
    // A step that ends early at a kink says nothing of steps that are much longer.
    const bool is_telling = !is_cut_ || kMostGrowth * h >= most_s;
    step->next_try_s = is_telling ? std::clamp(promised_s, h, std::max(h, most_s)) : most_s;
    return true;
  }
  is_limited_ = is_cut_ = false;
  failed_s_ = h;
  seconds_ = std::isfinite(error) ? std::clamp(promised_s, kMostShrinking * h, kLeastShrinking * h)
                                  : kMostShrinking * h;
  if (seconds_ < kShortestStepS) {
    throw std::runtime_error("no step is short enough for the accuracy");
  }
  return false;
}

}  // namespace tcs
