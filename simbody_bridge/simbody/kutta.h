// The arithmetic of Runge-Kutta 3(2), whoever evaluates the derivatives: Kutta's method of third
// order with the midpoint rule in it, whose difference says how long the steps may be. The method
// is that of Simbody's integrator of that name, which knows only one system with one clock.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "simbody_bridge/island_engine.h"

namespace tcs {

// The coordinates and speeds of a body or a joint in a state: where they begin, and how many there
// are. An error is a root mean square over those of one body or joint.
struct StateSlots {
  std::size_t q, q_count, u, u_count;
};

// The state where the second derivatives of a step of `h` seconds are taken, from those at its
// beginning.
void KuttaMiddle(const IslandStep& step, double h, std::vector<double>* state);
// The state where the third derivatives are taken.
void KuttaEnd(const IslandStep& step, const std::vector<double>& middle_rate, double h,
              std::vector<double>* state);
// The state where the step leads: step.to.
void KuttaStep(const std::vector<double>& middle_rate, const std::vector<double>& end_rate,
               double h, IslandStep* step);

// The greatest error among `count` bodies or joints, and `whose` it is, of coordinates or of
// speeds, relative for speeds above 1: NaN or infinite if any is. `error(i)` is the error of number
// i of the state, `slots_of` gives the StateSlots of each.
template <class Error, class SlotsOf>
double GreatestError(const IslandStep& step, const Error& error, std::size_t count,
                     const SlotsOf& slots_of, std::size_t* whose = nullptr) {
  const auto square = [](double x) { return x * x; };
  double greatest = 0, all = 0;
  for (std::size_t index = 0; index < count; ++index) {
    const StateSlots slots = slots_of(index);
    double coordinates = 0, speeds = 0;
    for (std::size_t i = slots.q; i < slots.q + slots.q_count; ++i) coordinates += square(error(i));
    for (std::size_t i = slots.u; i < slots.u + slots.u_count; ++i) {
      speeds += square(error(i) / std::max(1.0, std::abs(step.from[i])));
    }
    const double before = greatest;
    greatest = std::max({greatest, coordinates / static_cast<double>(slots.q_count),
                         speeds / static_cast<double>(slots.u_count)});
    const bool was_finite = std::isfinite(all);
    all += coordinates + speeds;
    if (whose != nullptr && was_finite && (greatest > before || !std::isfinite(all))) {
      *whose = index;
    }
  }
  return std::isfinite(all) ? std::sqrt(greatest) : all;
}

// The error of a step of `h` seconds that has been tried.
template <class SlotsOf>
double KuttaError(const IslandStep& step, const std::vector<double>& middle_rate, double h,
                  std::size_t count, const SlotsOf& slots_of, std::size_t* whose = nullptr) {
  const auto error = [&](std::size_t i) {
    return step.to[i] - (step.from[i] + h * middle_rate[i]);
  };
  return GreatestError(step, error, count, slots_of, whose);
}

// Shorter steps lead nowhere: islands count whole nanoseconds.
inline constexpr double kShortestStepS = 1e-9;

// The length of a step that error control lets be as long as it can.
class StepLength {
 public:
  StepLength() = default;
  // The length of a step that is at most `most_s` long.
  StepLength(const IslandStep& step, double most_s)
      : is_limited_(step.try_s > most_s), seconds_(std::min(step.try_s, most_s)) {}

  // The length to try.
  double seconds() const { return seconds_; }
  void Set(double seconds) { seconds_ = seconds; }
  // Makes the length shorter than error control has it, because of what happens then.
  void Cut(double seconds) {
    seconds_ = seconds;
    is_cut_ = true;
  }

  // Whether a try with this error is good enough: then the step is as long, and knows how long to
  // try the next one; else another length is to be tried. Throws std::runtime_error where no step
  // is short enough.
  bool Judge(double error, double accuracy, IslandStep* step);

 private:
  bool is_limited_ = false;  // shorter than error control has it
  bool is_cut_ = false;      // by Cut
  double seconds_ = 0;
  double failed_s_ = std::numeric_limits<double>::infinity();  // the last try that failed
};

}  // namespace tcs
