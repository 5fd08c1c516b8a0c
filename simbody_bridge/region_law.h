// The force of a region's walls on a body, the same for every engine. See RegionSpec for the law.
#pragma once

#include "simbody_bridge/dynamics.h"

namespace tcs {

// The wall's force along one axis on a body at `position_m` with `velocity_mps` along that axis, in
// newtons.
double WallForce(const RegionSpec& region, double position_m, double velocity_mps);
// Adds the force of all walls on the body.
void AddWallForce(const RegionSpec& region, const BodyState& body, std::array<double, 3>* force_n);

}  // namespace tcs
