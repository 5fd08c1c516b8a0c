#include "simbody_bridge/simbody/region_force.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simbody_bridge/region_law.h"

namespace tcs {

RegionForce::RegionForce(const RegionSpec& region, std::vector<SimTK::MobilizedBody::Free> bodies)
    : region_(region), bodies_(std::move(bodies)) {}

void RegionForce::calcForce(const SimTK::State& state,
                            SimTK::Vector_<SimTK::SpatialVec>& body_forces,
                            SimTK::Vector_<SimTK::Vec3>& /*particle_forces*/,
                            SimTK::Vector& /*mobility_forces*/) const {
  for (const auto& body : bodies_) {
    const SimTK::Vec3 position = body.getBodyOriginLocation(state);
    const SimTK::Vec3 velocity = body.getBodyOriginVelocity(state);
    SimTK::SpatialVec& body_force = body_forces[body.getMobilizedBodyIndex()];
    for (int axis = 0; axis < 3; ++axis) {
      body_force[1][axis] += WallForce(region_, position[axis], velocity[axis]);
    }
  }
}

SimTK::Real RegionForce::calcPotentialEnergy(const SimTK::State& state) const {
  double energy = 0;
  for (const auto& body : bodies_) {
    const SimTK::Vec3 position = body.getBodyOriginLocation(state);
    for (int axis = 0; axis < 3; ++axis) {
      const double penetration = std::max(0.0, std::abs(position[axis]) - region_.half_extent_m);
      energy += 0.5 * region_.stiffness_npm * penetration * penetration;
    }
  }
  return energy;
}

}  // namespace tcs
