#include "simbody_bridge/link_inertial.h"

#include <cmath>
#include <cstddef>

#include "simbody_bridge/frames.h"
#include "simbody_bridge/link_motion.h"
#include "simbody_bridge/model/vectors.h"

namespace tcs {
namespace {

using Vector = std::array<double, 3>;

// The vector that is constant along axes that turn by `turn_rad`, given its mean along the axes as
// they were before the turn: the inverse of the left Jacobian of the rotation.
Vector AlongTurningAxes(const Vector& turn_rad, const Vector& mean) {
  const double square =
      turn_rad[0] * turn_rad[0] + turn_rad[1] * turn_rad[1] + turn_rad[2] * turn_rad[2];
  const double angle = std::sqrt(square);
  const double twice = angle < 1e-4 ? 1.0 / 12 : (1 - angle / 2 / std::tan(angle / 2)) / square;
  const Vector once_turned = Cross(turn_rad, mean), turned = Cross(turn_rad, once_turned);
  Vector felt;
  for (std::size_t i = 0; i < 3; ++i) felt[i] = mean[i] - once_turned[i] / 2 + twice * turned[i];
  return felt;
}

}  // namespace

InertialReading LinkInertialSensor::Sample(VirtualTime at, const LinkState& frame) {
  InertialReading reading{InBody(frame.pose.orientation_xyzw, frame.angular_velocity_radps), {}};
  if (before_.has_value()) {
    const double seconds = static_cast<double>((at - before_->at).ns()) * 1e-9;
    const LinkState& before = before_->frame;
    Vector mean_mps2;
    for (std::size_t i = 0; i < 3; ++i) {
      mean_mps2[i] = (frame.linear_velocity_mps[i] - before.linear_velocity_mps[i]) / seconds -
                     gravity_mps2_[i];
    }
    const Vector turn_rad = TurnBetween(before.pose.orientation_xyzw, frame.pose.orientation_xyzw);
    reading.proper_acceleration_mps2 =
        AlongTurningAxes(turn_rad, InBody(before.pose.orientation_xyzw, mean_mps2));
  }
  before_ = {at, frame};
  return reading;
}

}  // namespace tcs
