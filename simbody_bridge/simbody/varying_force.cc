#include "simbody_bridge/simbody/varying_force.h"

#include "simbody_bridge/simbody/model.h"
#include "simbody_bridge/simbody/vectors.h"

namespace tcs {

void VaryingForce::calcForce(const SimTK::State& state,
                             SimTK::Vector_<SimTK::SpatialVec>& body_forces,
                             SimTK::Vector_<SimTK::Vec3>& /*particle_forces*/,
                             SimTK::Vector& /*mobility_forces*/) const {
  if (step_ == nullptr) return;
  const auto numbers = static_cast<std::size_t>(state.getNY());
  const std::span<const double> y(state.getY().getContiguousScalarData(), numbers);
  for (std::size_t place = 0; place < bodies_.size(); ++place) {
    if (loads_->IsConstant(*step_, place)) continue;
    const BodyState body = ReadBody(y, static_cast<int>(bodies_.size()), static_cast<int>(place));
    const Load load = loads_->At(*step_, place, state.getTime(), body);
    body_forces[bodies_[place].getMobilizedBodyIndex()] +=
        SimTK::SpatialVec(ToVec3(load.torque_nm), ToVec3(load.force_n));
  }
}

}  // namespace tcs
