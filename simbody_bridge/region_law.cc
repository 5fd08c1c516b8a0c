#include "simbody_bridge/region_law.h"

#include <algorithm>
#include <cmath>

namespace tcs {

double WallForce(const RegionSpec& region, double position_m, double velocity_mps) {
  const double penetration = std::abs(position_m) - region.half_extent_m;
  if (!(penetration > 0)) return 0;
  const double outward = std::copysign(1.0, position_m);
  const double push =
      region.stiffness_npm * penetration + region.damping_nspm * outward * velocity_mps;
  return -outward * std::max(0.0, push);
}

void AddWallForce(const RegionSpec& region, const BodyState& body, std::array<double, 3>* force_n) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    (*force_n)[axis] += WallForce(region, body.position_m[axis], body.linear_velocity_mps[axis]);
  }
}

}  // namespace tcs
