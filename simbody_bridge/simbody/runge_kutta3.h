// Runge-Kutta 3(2) for many islands of free bodies at once.
#pragma once

#include <span>
#include <vector>

#include "simbody_bridge/island_engine.h"
#include "simbody_bridge/simbody/kutta.h"
#include "simbody_bridge/simbody/rates.h"

namespace tcs {

class RungeKutta3 {
 public:
  // `accuracy` is the greatest error of a step: relative for speeds above 1, else absolute, as root
  // mean square over a body's coordinates or speeds.
  explicit RungeKutta3(double accuracy) : accuracy_(accuracy) {}

  // Takes steps of different islands that `rates` can evaluate. Throws std::runtime_error where no
  // step is short enough for the accuracy.
  void Take(SimbodyRates& rates, std::span<IslandStep* const> steps);

 private:
  struct Attempt {
    IslandStep* step;
    StepLength length;
    std::vector<double> state, middle_rate, end_rate;
  };
  void Begin(SimbodyRates& rates, std::span<IslandStep* const> steps);
  void TryOnce(SimbodyRates& rates);
  bool Judge(Attempt& attempt) const;

  const double accuracy_;
  std::vector<Attempt> attempts_;  // the first ones count, as many as there are steps
  std::vector<std::size_t> open_;  // the attempts that have not succeeded yet
  std::vector<SimbodyRates::Lane> lanes_;
};

}  // namespace tcs
