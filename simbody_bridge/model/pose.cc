#include "simbody_bridge/model/pose.h"

#include <cmath>
#include <cstddef>

#include "simbody_bridge/model/vectors.h"

namespace tcs {
namespace {

using Vector = std::array<double, 3>;
using Quaternion = std::array<double, 4>;

Quaternion Conjugate(const Quaternion& q) { return {-q[0], -q[1], -q[2], q[3]}; }

}  // namespace

Quaternion Normalised(const Quaternion& q) {
  Quaternion normalised = q;
  Normalise(normalised);
  return normalised;
}

Vector Rotate(const Quaternion& q, const Vector& v) { return TurnedBy(Normalised(q), v); }

Quaternion Times(const Quaternion& a, const Quaternion& b) {
  return {a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
          a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
          a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
          a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}

Pose Times(const Pose& first, const Pose& second) {
  Pose product;
  const Vector turned = Rotate(first.orientation_xyzw, second.position_m);
  for (std::size_t i = 0; i < 3; ++i) product.position_m[i] = first.position_m[i] + turned[i];
  product.orientation_xyzw = Normalised(Times(first.orientation_xyzw, second.orientation_xyzw));
  return product;
}

Pose Inverse(const Pose& pose) {
  const Quaternion back = Conjugate(Normalised(pose.orientation_xyzw));
  const Vector at = Rotate(back, pose.position_m);
  return {{-at[0], -at[1], -at[2]}, back};
}

Quaternion FromRollPitchYaw(double roll_rad, double pitch_rad, double yaw_rad) {
  const Quaternion roll = {std::sin(roll_rad / 2), 0, 0, std::cos(roll_rad / 2)};
  const Quaternion pitch = {0, std::sin(pitch_rad / 2), 0, std::cos(pitch_rad / 2)};
  const Quaternion yaw = {0, 0, std::sin(yaw_rad / 2), std::cos(yaw_rad / 2)};
  return Times(yaw, Times(pitch, roll));
}

}  // namespace tcs
