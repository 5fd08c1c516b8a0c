// The planner's model of the pursuit: the predator is a free rigid body under its wrench, the prey
// a point mass that flees when the predator is near; an elastic box holds both.
#pragma once

#include <ompl/control/SpaceInformation.h>
#include <ompl/control/StatePropagator.h>

#include "examples/predator_prey/common/body_state.h"
#include "examples/predator_prey/predator_planner/pursuit_space.h"

namespace predator_prey {

struct ModelOptions {
  double mass_kg = 1.0;
  double inertia_kgm2 = 0.1;  // the same about all axes
  double flee_distance_m = 5.0;
  double flee_force_n = 3.0;
  double box_half_extent_m = 10.0;
  double box_stiffness_npm = 50.0;
};

class PursuitPropagator : public ompl::control::StatePropagator {
 public:
  PursuitPropagator(const ompl::control::SpaceInformationPtr& si, const ModelOptions& options)
      : StatePropagator(si), options_(options) {}

  // One explicit step; the planner calls it with its propagation step size.
  void propagate(const ompl::base::State* state, const ompl::control::Control* control,
                 double duration_s, ompl::base::State* result) const override;

  bool canPropagateBackward() const override { return false; }

 private:
  Eigen::Vector3d BoxForce(const Eigen::Vector3d& position_m) const;
  Eigen::Vector3d FleeForce(const Pursuit& now) const;

  ModelOptions options_;
};

}  // namespace predator_prey
