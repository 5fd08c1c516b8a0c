// A robot with wheels on both sides that all look ahead: how it goes, and how they turn.
#pragma once

#include <algorithm>
#include <cmath>

namespace tcs {

struct WheelBase {
  double separation_m = 1;  // from the wheels on the left to those on the right
  double radius_m = 0.1;
};

// Along x and about z of the robot.
struct PlanarSpeed {
  double forward_mps = 0;
  double turn_radps = 0;

  bool operator==(const PlanarSpeed&) const = default;
};

// Positive is ahead.
struct WheelSpeeds {
  double left_radps = 0, right_radps = 0;
};

inline WheelSpeeds WheelSpeedsOf(const WheelBase& base, const PlanarSpeed& speed) {
  const double sideways_mps = speed.turn_radps * base.separation_m / 2;
  return {(speed.forward_mps - sideways_mps) / base.radius_m,
          (speed.forward_mps + sideways_mps) / base.radius_m};
}

// The same speeds, but no wheel turns faster than `most_radps`, and the robot goes along the same
// arc.
inline WheelSpeeds Limited(const WheelSpeeds& speeds, double most_radps) {
  const double fastest = std::max(std::abs(speeds.left_radps), std::abs(speeds.right_radps));
  if (fastest <= most_radps) return speeds;
  const double share = most_radps / fastest;
  return {share * speeds.left_radps, share * speeds.right_radps};
}

}  // namespace tcs
