// The goal: the predator at the prey, moving with it.
#pragma once

#include <ompl/base/SpaceInformation.h>
#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/util/RandomNumbers.h>

#include "examples/predator_prey/predator_planner/pursuit_space.h"

namespace predator_prey {

struct GoalOptions {
  double threshold_m = 0.25;
  double velocity_weight_s = 0.3;  // metres that a difference of 1 m/s counts as
  double horizon_s = 2.0;
};

class PursuitGoal : public ompl::base::GoalSampleableRegion {
 public:
  // Samples of the goal take the prey to go on from `start` as it moves there.
  PursuitGoal(const ompl::base::SpaceInformationPtr& si, const GoalOptions& options,
              const Pursuit& start);

  double distanceGoal(const ompl::base::State* state) const override;
  void sampleGoal(ompl::base::State* state) const override;
  unsigned int maxSampleCount() const override;

 private:
  GoalOptions options_;
  Pursuit start_;
  mutable ompl::RNG random_;
};

}  // namespace predator_prey
