#include "examples/predator_prey/predator_planner/time_near_prey.h"

#include "examples/predator_prey/predator_planner/pursuit_space.h"

namespace predator_prey {
namespace {

constexpr double kTimeCost = 0.5;  // per second; the distance costs 1 per metre and second

double CostRate(const Pursuit& at) {
  return kTimeCost + (at.prey_position_m - at.predator.position_m).norm();
}

}  // namespace

TimeNearPrey::TimeNearPrey(const ompl::base::SpaceInformationPtr& si) : OptimizationObjective(si) {
  description_ = "Time, and distance to the prey over time";
}

ompl::base::Cost TimeNearPrey::stateCost(const ompl::base::State* state) const {
  return ompl::base::Cost(CostRate(ReadState(state)));
}

ompl::base::Cost TimeNearPrey::motionCost(const ompl::base::State* from,
                                          const ompl::base::State* to) const {
  ++motions_;
  const Pursuit begin = ReadState(from);
  const Pursuit end = ReadState(to);
  return ompl::base::Cost(0.5 * (CostRate(begin) + CostRate(end)) * (end.time_s - begin.time_s));
}

}  // namespace predator_prey
