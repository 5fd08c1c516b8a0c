#include "examples/predator_prey/predator_planner/pursuit_goal.h"

#include <limits>

namespace predator_prey {

PursuitGoal::PursuitGoal(const ompl::base::SpaceInformationPtr& si, const GoalOptions& options,
                         const Pursuit& start)
    : GoalSampleableRegion(si), options_(options), start_(start) {
  setThreshold(options.threshold_m);
}

double PursuitGoal::distanceGoal(const ompl::base::State* state) const {
  const Pursuit at = ReadState(state);
  return (at.prey_position_m - at.predator.position_m).norm() +
         options_.velocity_weight_s *
             (at.prey_velocity_mps - at.predator.linear_velocity_mps).norm();
}

void PursuitGoal::sampleGoal(ompl::base::State* state) const {
  Pursuit caught = start_;
  caught.time_s = random_.uniformReal(0.0, options_.horizon_s);
  caught.prey_position_m += caught.time_s * caught.prey_velocity_mps;
  caught.predator.position_m = caught.prey_position_m;
  caught.predator.linear_velocity_mps = caught.prey_velocity_mps;
  WriteState(caught, state);
}

unsigned int PursuitGoal::maxSampleCount() const {
  return std::numeric_limits<unsigned int>::max();
}

}  // namespace predator_prey
