#include "coordinator/world/instruments/wheel_odometry.h"

#include <cmath>

namespace tcs {

WheelOdometry::WheelOdometry(const WheelOdometrySpec& spec)
    : spec_(spec), wheels_(spec.joints.size()) {
  measured_.frame = spec.frame;
  measured_.child_frame = spec.child_frame;
}

WheelOdometry::Sides WheelOdometry::MeansOf(double JointState::*what) const {
  Sides sides;
  const auto left = static_cast<double>(spec_.left);
  const double right = static_cast<double>(wheels_.size()) - left;
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    (i < spec_.left ? sides.left : sides.right) +=
        wheels_[i].*what / (i < spec_.left ? left : right);
  }
  return sides;
}

void WheelOdometry::Look(int, VirtualTime, const Eyes& eyes) {
  eyes.joints(spec_.joints, wheels_);
  const auto& [separation_m, radius_m] = spec_.base;
  const Sides turned_rad = MeansOf(&JointState::position);
  if (before_rad_) {
    const double left_m = radius_m * (turned_rad.left - before_rad_->left);
    const double right_m = radius_m * (turned_rad.right - before_rad_->right);
    Go((left_m + right_m) / 2, (right_m - left_m) / separation_m);
  }
  before_rad_ = turned_rad;
  const Sides speed = MeansOf(&JointState::velocity);
  measured_.linear_mps = {radius_m * (speed.left + speed.right) / 2, 0, 0};
  measured_.angular_radps = {0, 0, radius_m * (speed.right - speed.left) / separation_m};
}

// Along an arc, whose chord looks half the turn ahead.
void WheelOdometry::Go(double ahead_m, double turn_rad) {
  const double half = turn_rad / 2;
  const double chord_m = ahead_m * (std::abs(half) < 1e-8 ? 1 : std::sin(half) / half);
  measured_.pose.position_m[0] += chord_m * std::cos(yaw_rad_ + half);
  measured_.pose.position_m[1] += chord_m * std::sin(yaw_rad_ + half);
  yaw_rad_ += turn_rad;
  measured_.pose.orientation_xyzw = FromRollPitchYaw(0, 0, yaw_rad_);
}

}  // namespace tcs
