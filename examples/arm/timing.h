// How fast the arm goes along a way.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "examples/arm/trajectory.h"

namespace arm {

inline constexpr double kPointS = 0.04;  // between the points of a trajectory

inline const Joints kMostVelocity{2.6, 2.6, 2.6, 2.8, 2.8, 2.8};  // rad/s
inline const Joints kMostAcceleration{8, 8, 10, 16, 16, 16};      // rad/s^2

// The share of the way that is done after a share of the time.
inline double Eased(double share) {
  const double t = std::clamp(share, 0.0, 1.0);
  return t * t * t * (10 + t * (6 * t - 15));
}

// From one stand to another at the least, from rest to rest: no joint is there earlier.
inline double QuickestS(const Joints& from, const Joints& to) {
  double seconds = 0;
  for (int i = 0; i < kJoints; ++i) {
    const double way = std::abs(to[i] - from[i]);
    const double v = kMostVelocity[i], a = kMostAcceleration[i];
    seconds = std::max(seconds, way < v * v / a ? 2 * std::sqrt(way / a) : way / v + v / a);
  }
  return seconds;
}

// Along many stands, each near the one before it: as fast as speeds and accelerations allow, the
// speed along the way being raised forwards and braked backwards (the phase plane of Bobrow,
// Dubowsky and Gibson, 1985).
Points Timed(const std::vector<Joints>& way);

}  // namespace arm
