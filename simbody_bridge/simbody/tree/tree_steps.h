// Runge-Kutta 3(2) for one island of models: coordinates and speeds are those of joints.
#pragma once

#include <vector>

#include "simbody_bridge/island_engine.h"
#include "simbody_bridge/model_loads.h"
#include "simbody_bridge/simbody/tree/tree.h"

namespace tcs {

class TreeSteps {
 public:
  // As long as error control lets it be, and no longer than `limit_s`, which is within the step's.
  // `accuracy` as of RungeKutta3, over a joint's coordinates or speeds. Throws std::runtime_error
  // where no step is short enough for it.
  void TakeControlled(SimbodyTree& tree, ModelLoads& loads, IslandStep& step, double accuracy,
                      double limit_s);
  // As long as its limit.
  void TakeWhole(SimbodyTree& tree, ModelLoads& loads, IslandStep& step);

 private:
  void Begin(SimbodyTree& tree, ModelLoads& loads, IslandStep& step);
  void Try(SimbodyTree& tree, ModelLoads& loads, IslandStep& step, double length_s);
  double ErrorOf(const SimbodyTree& tree, const IslandStep& step, double length_s) const;

  std::vector<double> state_, middle_rate_, end_rate_;
};

}  // namespace tcs
