// The wrenches that act on links, as a Simbody force element.
#pragma once

#include <span>
#include <vector>

#include "simbody_bridge/model/forest.h"
#include "simbody_bridge/model_engine.h"
#include "simbody_bridge/simbody/simbody.h"

namespace tcs {

class LinkForce : public SimTK::Force::Custom::Implementation {
 public:
  // `forest` and `acting`, by place, outlive this.
  LinkForce(const Forest& forest, std::vector<SimTK::MobilizedBody> bodies,
            const std::span<const Wrench>& acting);

  void calcForce(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>& body_forces,
                 SimTK::Vector_<SimTK::Vec3>& particle_forces,
                 SimTK::Vector& mobility_forces) const override;
  SimTK::Real calcPotentialEnergy(const SimTK::State& /*state*/) const override { return 0; }

 private:
  const Forest& forest_;
  const std::vector<SimTK::MobilizedBody> bodies_;
  const std::span<const Wrench>& acting_;
};

}  // namespace tcs
