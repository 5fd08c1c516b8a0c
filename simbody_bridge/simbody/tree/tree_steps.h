// Runge-Kutta 3(2) for one island of models: coordinates and speeds are those of joints.
#pragma once

#include <vector>

#include "simbody_bridge/simbody/tree/controlled_steps.h"

namespace tcs {

class TreeSteps : public ControlledSteps<TreeSteps> {
 private:
  friend class ControlledSteps<TreeSteps>;
  void Begin(SimbodyTree& tree, ModelLoads& loads, IslandStep& step);
  void Try(SimbodyTree& tree, ModelLoads& loads, IslandStep& step, double length_s);
  double ErrorOf(const SimbodyTree& tree, const IslandStep& step, double length_s);
  void EndAtEvent(SimbodyTree& /*tree*/, ModelLoads& /*loads*/, IslandStep& /*step*/) {}
  double PredictKink(const SimbodyTree& /*tree*/, ModelLoads& /*loads*/, const IslandStep& /*step*/,
                     double length_s) {
    return length_s;
  }
  double LateKink(const SimbodyTree& /*tree*/, ModelLoads& /*loads*/, const IslandStep& /*step*/,
                  double length_s) {
    return length_s;
  }
  double FirstKink(const SimbodyTree& /*tree*/, ModelLoads& /*loads*/, const IslandStep& /*step*/,
                   double length_s) {
    return length_s;
  }

  std::vector<double> state_, middle_rate_, end_rate_;
};

}  // namespace tcs
