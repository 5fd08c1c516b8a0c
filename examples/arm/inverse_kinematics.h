// How the arm stands when its tool points straight down at a place.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "examples/arm/arm_model.h"

namespace arm {

// The tool's place in the world, and the way its x axis points. None where the arm does not reach.
// Of the ways to stand: with the elbow above, the tool outside of the wrist, and the last joint
// near an angle (a part has no front: half a turn more does as well).
inline std::optional<Joints> ToolDownAt(const Vector3d& tool_m, double yaw_rad, double near_rad) {
  const double aside = kArm[1].at_m.y() + kArm[2].at_m.y() + kArm[4].at_m.y();
  const double upper = kArm[2].at_m.z(), fore = kArm[3].at_m.z();
  const Vector3d at = tool_m - kBaseM;
  const double far_squared = at.head<2>().squaredNorm() - aside * aside;
  if (far_squared < 0) return std::nullopt;
  // Of the first wrist joint from the shoulder, in the plane of the arm.
  const double ahead = std::sqrt(far_squared) - kArm[5].at_m.z();
  const double above = at.z() - kArm[0].at_m.z() + kToolM.y();
  const double cosine =
      (ahead * ahead + above * above - upper * upper - fore * fore) / (2 * upper * fore);
  if (std::abs(cosine) > 1) return std::nullopt;
  Joints q;
  q[0] = std::atan2(at.y(), at.x()) - std::atan2(aside, std::sqrt(far_squared));
  q[2] = std::acos(cosine);
  q[1] =
      std::atan2(ahead, above) - std::atan2(fore * std::sin(q[2]), upper + fore * std::cos(q[2]));
  q[3] = M_PI / 2 - q[1] - q[2];
  q[4] = -M_PI / 2;
  const double last = q[0] - M_PI / 2 - yaw_rad;
  q[5] = last - M_PI * std::round((last - near_rad) / M_PI);
  for (std::size_t i = 0; i < kJoints; ++i) {
    if (std::abs(q[static_cast<int>(i)]) > kArm[i].most_rad) return std::nullopt;
  }
  return q;
}

}  // namespace arm
