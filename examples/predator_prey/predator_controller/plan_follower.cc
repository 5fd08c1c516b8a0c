#include "examples/predator_prey/predator_controller/plan_follower.h"

#include <utility>

namespace predator_prey {
namespace {

// The rotation that leads from `from` to `to`, as axis times angle [rad] in the world frame.
Eigen::Vector3d RotationBetween(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  const Eigen::AngleAxisd rotation(to * from.conjugate());
  return rotation.angle() * rotation.axis();
}

Eigen::Vector3d Clamp(const Eigen::Vector3d& v, double limit) {
  return v.cwiseMax(-limit).cwiseMin(limit);
}

}  // namespace

void PlanFollower::Start(std::vector<PlanStep> plan, double time_s) {
  plan_ = std::move(plan);
  started_s_ = time_s;
}

std::optional<Wrench> PlanFollower::Control(double time_s, const BodyState& actual) const {
  const double elapsed_s = time_s - started_s_;
  // A control that would not be over in time is not begun; a timer may be late by a little.
  const double tolerance_s = 0.1 * options_.period_s;
  if (elapsed_s + options_.period_s > options_.execute_s + tolerance_s) return std::nullopt;
  double step_end_s = 0.0;
  for (const PlanStep& step : plan_) {
    step_end_s += step.duration_s;
    if (elapsed_s < step_end_s) return Track(step, actual);
  }
  return std::nullopt;
}

Wrench PlanFollower::Track(const PlanStep& step, const BodyState& actual) const {
  const BodyState& expected = step.expected;
  const Eigen::Vector3d acceleration_mps2 =
      options_.kp_per_s2 * (expected.position_m - actual.position_m) +
      options_.kd_per_s * (expected.linear_velocity_mps - actual.linear_velocity_mps);
  const Eigen::Vector3d angular_acceleration_radps2 =
      options_.kp_per_s2 * RotationBetween(actual.orientation, expected.orientation) +
      options_.kd_per_s * (expected.angular_velocity_radps - actual.angular_velocity_radps);
  return {.force_n = Clamp(step.control.force_n + options_.mass_kg * acceleration_mps2,
                           options_.max_force_n),
          .torque_nm =
              Clamp(step.control.torque_nm + options_.inertia_kgm2 * angular_acceleration_radps2,
                    options_.max_torque_nm)};
}

}  // namespace predator_prey
