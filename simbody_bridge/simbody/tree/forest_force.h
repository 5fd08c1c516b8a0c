// A Simbody force element of a forest: a part of the loads that the commands make act in the
// forest.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "simbody_bridge/model/forest.h"
#include "simbody_bridge/model_engine.h"
#include "simbody_bridge/simbody/simbody.h"

namespace tcs {

class ForestForce : public SimTK::Force::Custom::Implementation {
 public:
  // `forest` and `acting`, by place, outlive this.
  ForestForce(const Forest& forest, std::vector<SimTK::MobilizedBody> bodies,
              const std::span<const Wrench>& acting)
      : forest_(forest), bodies_(std::move(bodies)), acting_(acting) {}

  // No caller asks for the energy.
  SimTK::Real calcPotentialEnergy(const SimTK::State& /*state*/) const final { return 0; }

 protected:
  const SimTK::MobilizedBody& BodyAt(int index) const {
    return bodies_[static_cast<std::size_t>(index)];
  }

  const Forest& forest_;
  const std::vector<SimTK::MobilizedBody> bodies_;
  const std::span<const Wrench>& acting_;
};

}  // namespace tcs
