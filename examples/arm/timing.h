// How fast the arm goes along a way: from rest to rest with the least jerk, in the shortest time in
// which no joint is too fast.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "examples/arm/trajectory.h"

namespace arm {

inline constexpr double kPointS = 0.04;  // between the points of a trajectory

inline const Joints kMostVelocity{2.6, 2.6, 2.6, 2.8, 2.8, 2.8};  // rad/s
inline const Joints kMostAcceleration{9, 9, 10, 16, 16, 16};      // rad/s^2

// The share of the way that is done after a share of the time.
inline double Eased(double share) {
  const double t = std::clamp(share, 0.0, 1.0);
  return t * t * t * (10 + t * (6 * t - 15));
}

// From one stand to another, on the straight line.
inline double QuickestS(const Joints& from, const Joints& to) {
  const Joints way = (to - from).cwiseAbs();
  return std::max(1.875 * way.cwiseQuotient(kMostVelocity).maxCoeff(),
                  std::sqrt(5.7735 * way.cwiseQuotient(kMostAcceleration).maxCoeff()));
}

// Along many stands, each near the one before it.
inline Points Timed(const std::vector<Joints>& way) {
  std::vector<double> length{0};
  for (std::size_t i = 1; i < way.size(); ++i) {
    length.push_back(length.back() + (way[i] - way[i - 1]).norm());
  }
  const auto at = [&](double share) -> Joints {
    const double far = Eased(share) * length.back();
    const auto next = std::upper_bound(length.begin() + 1, length.end() - 1, far) - length.begin();
    const auto k = static_cast<std::size_t>(next);
    const double step = length[k] - length[k - 1];
    return way[k - 1] + (step > 0 ? (far - length[k - 1]) / step : 0) * (way[k] - way[k - 1]);
  };
  // What the fastest joint needs, looked at in steps of the whole.
  constexpr int kSteps = 50;
  double seconds = 0.1;
  for (int i = 0; i <= kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps, h = 1.0 / kSteps;
    const Joints before = at(share - h), here = at(share), after = at(share + h);
    const Joints velocity = ((after - before) / (2 * h)).cwiseAbs();
    const Joints acceleration = ((after - 2 * here + before) / (h * h)).cwiseAbs();
    seconds = std::max(
        {seconds, velocity.cwiseQuotient(kMostVelocity).maxCoeff(),
         std::sqrt(acceleration.cwiseQuotient(kMostAcceleration).maxCoeff())});
  }
  const auto count = static_cast<std::size_t>(std::ceil(seconds / kPointS));
  Points points;
  for (std::size_t i = 0; i <= count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count);
    const double h = 0.5 / static_cast<double>(count);
    const bool is_end = i == 0 || i == count;
    points.push_back({share * seconds, at(share),
                      is_end ? Joints::Zero() : Joints((at(share + h) - at(share - h)) / (2 * h) / seconds)});
  }
  return points;
}

}  // namespace arm
