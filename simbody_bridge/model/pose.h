// Where a frame is in another one, and the algebra of that.
#pragma once

#include <array>

namespace tcs {

// The frame's origin and axes, in the coordinates of the frame that it is in. A point p of the
// frame is at position_m + orientation * p there.
struct Pose {
  std::array<double, 3> position_m{};
  std::array<double, 4> orientation_xyzw{0, 0, 0, 1};  // unit length, within 1e-3

  bool operator==(const Pose&) const = default;
};

// The vector `v` of the frame with the orientation `q` (any length but 0), in the outer frame.
std::array<double, 3> Rotate(const std::array<double, 4>& q, const std::array<double, 3>& v);
// First `second`, then `first`, as of nested frames: `second` is in the frame of `first`.
std::array<double, 4> Times(const std::array<double, 4>& first,
                            const std::array<double, 4>& second);
Pose Times(const Pose& first, const Pose& second);
Pose Inverse(const Pose& pose);
// Of unit length.
std::array<double, 4> Normalised(const std::array<double, 4>& q);
// The orientation that URDF means by roll, pitch and yaw: about the fixed axes x, then y, then z.
std::array<double, 4> FromRollPitchYaw(double roll_rad, double pitch_rad, double yaw_rad);

}  // namespace tcs
