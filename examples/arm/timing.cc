#include "examples/arm/timing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace arm {
namespace {

constexpr std::size_t kSteps = 60;  // of equal length along the way

// Stands at equal distances along the way.
std::vector<Joints> Even(const std::vector<Joints>& way) {
  std::vector<double> length{0};
  for (std::size_t i = 1; i < way.size(); ++i) {
    length.push_back(length.back() + (way[i] - way[i - 1]).norm());
  }
  std::vector<Joints> even;
  std::size_t next = 1;
  for (std::size_t i = 0; i <= kSteps; ++i) {
    const double far = length.back() * static_cast<double>(i) / kSteps;
    while (next + 1 < way.size() && length[next] < far) ++next;
    const double step = length[next] - length[next - 1];
    even.push_back(way[next - 1] +
                   (step > 0 ? (far - length[next - 1]) / step : 0) * (way[next] - way[next - 1]));
  }
  return even;
}

// The most of `x` with |a x + b| within the limits, for each joint; none where b alone is beyond.
double MostWith(const Joints& a, const Joints& b, const Joints& limit) {
  double most = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kJoints; ++i) {
    if (a[i] == 0) continue;
    most = std::min(most, (limit[i] - std::copysign(b[i], a[i] * b[i])) / std::abs(a[i]));
  }
  return std::max(most, 0.0);
}

}  // namespace

Points Timed(const std::vector<Joints>& way) {
  const std::vector<Joints> stands = Even(way);
  const auto slope = [&](std::size_t i) -> Joints {  // for each step
    return (stands[std::min(i + 1, kSteps)] - stands[i == 0 ? 0 : i - 1]) /
           (i == 0 || i == kSteps ? 1 : 2);
  };
  const auto bend = [&](std::size_t i) -> Joints {
    if (i == 0 || i == kSteps) return Joints::Zero();
    return stands[i + 1] - 2 * stands[i] + stands[i - 1];
  };
  // Of steps in a second, squared: what speed and bend allow, then what raising and braking do.
  std::vector<double> speed(kSteps + 1, 0);
  for (std::size_t i = 1; i < kSteps; ++i) {
    const double by_speed = kMostVelocity.cwiseQuotient(slope(i).cwiseAbs()).minCoeff();
    const double by_bend = kMostAcceleration.cwiseQuotient(bend(i).cwiseAbs()).minCoeff();
    speed[i] = std::min(by_speed * by_speed, 0.7 * by_bend);
  }
  const auto gain = [&](std::size_t i, double way_round) {
    return 2 * MostWith(slope(i), way_round * speed[i] * bend(i), kMostAcceleration);
  };
  for (std::size_t i = 0; i < kSteps; ++i) {
    speed[i + 1] = std::min(speed[i + 1], speed[i] + gain(i, 1));
  }
  for (std::size_t i = kSteps; i > 0; --i) {
    speed[i - 1] = std::min(speed[i - 1], speed[i] + gain(i, -1));
  }
  Points points{{0, stands[0], Joints::Zero()}};
  for (std::size_t i = 1; i <= kSteps; ++i) {
    const double step_s = 2 / (std::sqrt(speed[i - 1]) + std::sqrt(speed[i]));
    points.push_back({points.back().at_s + step_s, stands[i], std::sqrt(speed[i]) * slope(i)});
  }
  return points;
}

}  // namespace arm
