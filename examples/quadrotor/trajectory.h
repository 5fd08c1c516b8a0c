// A flight to a point at rest: on each axis the cubic with the least acceleration.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "examples/quadrotor/vectors.h"

namespace quadrotor {

struct Motion {
  Vector3d position_m, velocity_mps, acceleration_mps2;
};

class Trajectory {
 public:
  // From where `from` is at the time `start_s`, and as fast, to the goal, in `length_s`.
  Trajectory(const Motion& from, const Vector3d& goal_m, double start_s, double length_s)
      : start_s_(start_s), length_s_(length_s) {
    const double t = length_s;
    const Vector3d way_m = goal_m - from.position_m;
    terms_ = {from.position_m, from.velocity_mps, 3 / (t * t) * way_m - 2 / t * from.velocity_mps,
              -2 / (t * t * t) * way_m + 1 / (t * t) * from.velocity_mps};
  }

  explicit Trajectory(const nlohmann::json& json)
      : start_s_(json.at("start")), length_s_(json.at("length")) {
    for (std::size_t i = 0; i < terms_.size(); ++i) terms_[i] = VectorOf(json.at("terms").at(i));
  }

  nlohmann::json ToJson() const {
    nlohmann::json terms;
    for (const Vector3d& term : terms_) terms.push_back(JsonOf(term));
    return {{"start", start_s_}, {"length", length_s_}, {"terms", terms}};
  }

  double length_s() const { return length_s_; }

  // At rest at the goal once it is over.
  Motion At(double seconds) const {
    const double t = std::clamp(seconds - start_s_, 0.0, length_s_);
    Motion motion{Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
    for (std::size_t k = terms_.size(); k-- > 0;) {
      motion.acceleration_mps2 = motion.acceleration_mps2 * t + 2 * motion.velocity_mps;
      motion.velocity_mps = motion.velocity_mps * t + motion.position_m;
      motion.position_m = motion.position_m * t + terms_[k];
    }
    if (seconds >= start_s_ + length_s_) motion.acceleration_mps2.setZero();
    return motion;
  }

 private:
  double start_s_, length_s_;
  std::array<Vector3d, 4> terms_;  // of the powers of the time since the start
};

}  // namespace quadrotor
