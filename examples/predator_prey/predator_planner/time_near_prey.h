// What a plan costs: its duration, and the distance to the prey integrated over it.
#pragma once

#include <ompl/base/OptimizationObjective.h>

#include <cstdint>

namespace predator_prey {

class TimeNearPrey : public ompl::base::OptimizationObjective {
 public:
  explicit TimeNearPrey(const ompl::base::SpaceInformationPtr& si);

  ompl::base::Cost stateCost(const ompl::base::State* state) const override;
  ompl::base::Cost motionCost(const ompl::base::State* from,
                              const ompl::base::State* to) const override;

  // Motions rated so far: one for each state that the planner has reached.
  std::uint64_t motions() const { return motions_; }

 private:
  mutable std::uint64_t motions_ = 0;
};

}  // namespace predator_prey
