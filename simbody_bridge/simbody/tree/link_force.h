// The wrenches that act on links, as a Simbody force element.
#pragma once

#include "simbody_bridge/simbody/tree/forest_force.h"

namespace tcs {

class LinkForce : public ForestForce {
 public:
  using ForestForce::ForestForce;

  void calcForce(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>& body_forces,
                 SimTK::Vector_<SimTK::Vec3>& particle_forces,
                 SimTK::Vector& mobility_forces) const override;
};

}  // namespace tcs
