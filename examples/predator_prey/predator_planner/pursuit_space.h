// The space in which the pursuit is planned: where the predator is and how it moves, where the prey
// is and how it moves, and the time since the plan's beginning. Controls are the predator's force
// and torque.
#pragma once

#include <ompl/base/StateSpace.h>
#include <ompl/control/ControlSpace.h>

#include <Eigen/Geometry>

#include "examples/predator_prey/common/body_state.h"

namespace predator_prey {

struct SpaceOptions {
  double horizon_s = 2.0;  // no plan is longer
  // Far beyond what can happen: from a start outside its bounds the planner finds nothing.
  double position_bound_m = 30.0;
  double velocity_bound_mps = 60.0;
  double angular_velocity_bound_radps = 100.0;
  double max_force_n = 10.0;  // per axis, as for the torque
  double max_torque_nm = 0.1;
};

// What a state holds.
struct Pursuit {
  BodyState predator;
  Eigen::Vector3d prey_position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d prey_velocity_mps = Eigen::Vector3d::Zero();
  double time_s = 0.0;
};

ompl::base::StateSpacePtr MakePursuitSpace(const SpaceOptions& options);
ompl::control::ControlSpacePtr MakeWrenchSpace(const ompl::base::StateSpacePtr& space,
                                               const SpaceOptions& options);

Pursuit ReadState(const ompl::base::State* state);
void WriteState(const Pursuit& pursuit, ompl::base::State* state);
Wrench ReadControl(const ompl::control::Control* control);

}  // namespace predator_prey
