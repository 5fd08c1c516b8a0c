// Joints along points in time, on cubics between them, as a JointTrajectory has them.
#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "examples/arm/arm_model.h"

namespace arm {

struct Point {
  double at_s;  // since the beginning
  Joints position, velocity;
};
using Points = std::vector<Point>;

struct Motion {
  Joints position, velocity, acceleration;
};

class Trajectory {
 public:
  // Two points at least.
  Trajectory(double start_s, Points points) : start_s_(start_s), points_(std::move(points)) {}

  explicit Trajectory(const nlohmann::json& json) : start_s_(json.at("start")) {
    for (const auto& point : json.at("points")) {
      points_.push_back({point.at("time_from_start"), JointsOf(point.at("positions")),
                         JointsOf(point.at("velocities"))});
    }
  }

  nlohmann::json ToJson() const {
    nlohmann::json points, names;
    for (const Joint& joint : kArm) names.push_back(joint.name);
    for (const Point& point : points_) {
      points.push_back({{"time_from_start", point.at_s},
                        {"positions", JsonOf(point.position)},
                        {"velocities", JsonOf(point.velocity)}});
    }
    return {{"joints", names}, {"start", start_s_}, {"points", points}};
  }

  double start_s() const { return start_s_; }
  double end_s() const { return start_s_ + points_.back().at_s; }

  // At rest before it begins, and once it is over.
  Motion At(double seconds) const {
    const double t = seconds - start_s_;
    if (t <= 0) return AtRest(points_.front());
    if (t >= points_.back().at_s) return AtRest(points_.back());
    const auto next = std::upper_bound(points_.begin(), points_.end(), t,
                                       [](double at, const Point& p) { return at < p.at_s; });
    const Point &from = *(next - 1), &to = *next;
    const double h = to.at_s - from.at_s, u = (t - from.at_s) / h;
    const Joints way = to.position - from.position;
    const Joints square = 3 * way - h * (2 * from.velocity + to.velocity);
    const Joints cube = h * (from.velocity + to.velocity) - 2 * way;
    return {from.position + u * (h * from.velocity + u * (square + u * cube)),
            from.velocity + u * (2 * square + 3 * u * cube) / h,
            (2 * square + 6 * u * cube) / (h * h)};
  }

 private:
  static Motion AtRest(const Point& point) {
    return {point.position, Joints::Zero(), Joints::Zero()};
  }
  static Joints JointsOf(const nlohmann::json& list) {
    Joints joints;
    for (int i = 0; i < kJoints; ++i) joints[i] = list.at(static_cast<std::size_t>(i));
    return joints;
  }
  static nlohmann::json JsonOf(const Joints& joints) {
    return std::vector<double>(joints.begin(), joints.end());
  }

  double start_s_;
  Points points_;
};

}  // namespace arm
