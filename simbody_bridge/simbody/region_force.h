// The walls of a region as a Simbody force element. See RegionSpec for the law.
#pragma once

#include <vector>

#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/simbody/simbody.h"

namespace tcs {

class RegionForce : public SimTK::Force::Custom::Implementation {
 public:
  // Acts on the centre of mass, the origin, of each of `bodies`.
  RegionForce(const RegionSpec& region, std::vector<SimTK::MobilizedBody::Free> bodies);

  void calcForce(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>& body_forces,
                 SimTK::Vector_<SimTK::Vec3>& particle_forces,
                 SimTK::Vector& mobility_forces) const override;
  SimTK::Real calcPotentialEnergy(const SimTK::State& state) const override;

 private:
  RegionSpec region_;
  std::vector<SimTK::MobilizedBody::Free> bodies_;
};

}  // namespace tcs
