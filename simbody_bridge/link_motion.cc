#include "simbody_bridge/link_motion.h"

#include <cmath>
#include <cstddef>

namespace tcs {

std::array<double, 3> TurnBetween(const std::array<double, 4>& from,
                                  const std::array<double, 4>& to) {
  const std::array<double, 4> back = {-from[0], -from[1], -from[2], from[3]};
  std::array<double, 4> q = Normalised(Times(back, to));
  if (q[3] < 0) q = {-q[0], -q[1], -q[2], -q[3]};
  const double sine = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]);
  const double scale = sine < 1e-12 ? 2 : 2 * std::atan2(sine, q[3]) / sine;
  return {scale * q[0], scale * q[1], scale * q[2]};
}

std::array<double, 4> Turned(const std::array<double, 4>& q,
                             const std::array<double, 3>& turn_rad) {
  const double angle = std::hypot(turn_rad[0], turn_rad[1], turn_rad[2]);
  if (angle == 0) return q;
  const double scale = std::sin(angle / 2) / angle;
  return Normalised(Times(
      q, {scale * turn_rad[0], scale * turn_rad[1], scale * turn_rad[2], std::cos(angle / 2)}));
}

Pose PoseBetween(const LinkState& from, const LinkState& to, double seconds, double part) {
  if (part <= 0) return from.pose;
  if (part >= 1) return to.pose;
  const double t = part, left = 1 - part;
  Pose pose;
  for (std::size_t i = 0; i < 3; ++i) {
    pose.position_m[i] =
        left * left * (1 + 2 * t) * from.pose.position_m[i] +
        t * t * (3 - 2 * t) * to.pose.position_m[i] +
        seconds * t * left * (left * from.linear_velocity_mps[i] - t * to.linear_velocity_mps[i]);
  }
  std::array<double, 3> turn = TurnBetween(from.pose.orientation_xyzw, to.pose.orientation_xyzw);
  for (double& axis : turn) axis *= t;
  pose.orientation_xyzw = Turned(from.pose.orientation_xyzw, turn);
  return pose;
}

LinkState Mounted(const LinkState& link, const Pose& at) {
  LinkState mounted = link;
  mounted.pose = Times(link.pose, at);
  const std::array<double, 3> arm = Rotate(link.pose.orientation_xyzw, at.position_m);
  const auto& [wx, wy, wz] = link.angular_velocity_radps;
  mounted.linear_velocity_mps[0] += wy * arm[2] - wz * arm[1];
  mounted.linear_velocity_mps[1] += wz * arm[0] - wx * arm[2];
  mounted.linear_velocity_mps[2] += wx * arm[1] - wy * arm[0];
  return mounted;
}

}  // namespace tcs
