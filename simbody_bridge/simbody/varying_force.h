// The push on bodies in the course of a step, as a Simbody force element: the loads that loads.h
// computes from the time and from how the bodies are. For integrators that evaluate forces by
// themselves.
#pragma once

#include <utility>
#include <vector>

#include "simbody_bridge/loads.h"
#include "simbody_bridge/simbody/simbody.h"

namespace tcs {

class VaryingForce : public SimTK::Force::Custom::Implementation {
 public:
  explicit VaryingForce(std::vector<SimTK::MobilizedBody::Free> bodies)
      : bodies_(std::move(bodies)) {}

  // The step that is being taken, whose bodies these are; a state's time is the time since the
  // step's beginning. `loads` and `step` outlive the taking of the step. The caller evaluates no
  // state from before.
  void Set(const Loads& loads, const IslandStep& step) { loads_ = &loads, step_ = &step; }

  // Loads that are IsConstant are left out.
  void calcForce(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>& body_forces,
                 SimTK::Vector_<SimTK::Vec3>& particle_forces,
                 SimTK::Vector& mobility_forces) const override;
  SimTK::Real calcPotentialEnergy(const SimTK::State& /*state*/) const override { return 0; }

 private:
  const std::vector<SimTK::MobilizedBody::Free> bodies_;
  const Loads* loads_ = nullptr;
  const IslandStep* step_ = nullptr;
};

}  // namespace tcs
