#include "simbody_bridge/model/joint_trajectory.h"

#include <algorithm>
#include <cmath>

namespace tcs {
namespace {

bool AreFinite(std::span<const double> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double n) { return std::isfinite(n); });
}

// A cubic, by Hermite: at the share `t` of `seconds`.
JointSetpoint Along(const JointSetpoint& a, const JointSetpoint& b, double seconds, double t) {
  const double left = 1 - t;
  return {left * left * (1 + 2 * t) * a.position + t * t * (3 - 2 * t) * b.position +
              seconds * t * left * (left * a.velocity - t * b.velocity),
          6 * t * left * (b.position - a.position) / seconds + left * (1 - 3 * t) * a.velocity +
              t * (3 * t - 2) * b.velocity};
}

}  // namespace

std::string WhatIsWrongWith(const JointTrajectory& trajectory) {
  if (trajectory.points.empty()) return "has no points";
  if (trajectory.joints.empty()) return "names no joints";
  VirtualDuration before = VirtualDuration::Nanoseconds(-1);
  for (const JointTrajectory::Point& point : trajectory.points) {
    if (point.at <= before) return "has a point that is not after the one before it";
    before = point.at;
    const std::size_t joints = trajectory.joints.size();
    const auto is_other = [joints](std::size_t count) { return count != joints; };
    if (is_other(point.positions.size()) ||
        (!point.velocities.empty() && is_other(point.velocities.size()))) {
      return "has a point with another number of positions or velocities than it names joints";
    }
    if (!AreFinite(point.positions) || !AreFinite(point.velocities)) {
      return "has a number that is not finite";
    }
  }
  return {};
}

void LeaveOut(std::size_t number, JointTrajectory* trajectory) {
  const auto erase = [at = static_cast<std::ptrdiff_t>(number)](auto* of_joints) {
    if (!of_joints->empty()) of_joints->erase(of_joints->begin() + at);
  };
  erase(&trajectory->joints);
  for (JointTrajectory::Point& point : trajectory->points) {
    erase(&point.positions);
    erase(&point.velocities);
  }
}

JointSetpoint SetpointAt(const JointTrajectory& trajectory, std::size_t joint, double from,
                         VirtualDuration after) {
  const std::vector<JointTrajectory::Point>& points = trajectory.points;
  const auto next = std::find_if(points.begin(), points.end(),
                                 [after](const auto& point) { return point.at > after; });
  if (next == points.end()) return {points.back().positions[joint], 0};
  const bool is_first = next == points.begin();
  const VirtualDuration begun = is_first ? VirtualDuration{} : std::prev(next)->at;
  const double seconds = (next->at - begun).seconds();
  const double part = std::max(0.0, (after - begun).seconds() / seconds);
  JointSetpoint a{is_first ? from : std::prev(next)->positions[joint], 0};
  JointSetpoint b{next->positions[joint], 0};
  const bool is_curved =
      !next->velocities.empty() && (is_first || !std::prev(next)->velocities.empty());
  if (!is_curved) {
    const double speed = (b.position - a.position) / seconds;
    return {a.position + part * (b.position - a.position), speed};
  }
  if (!is_first) a.velocity = std::prev(next)->velocities[joint];
  b.velocity = next->velocities[joint];
  return Along(a, b, seconds, part);
}

}  // namespace tcs
