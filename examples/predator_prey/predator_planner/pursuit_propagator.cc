#include "examples/predator_prey/predator_planner/pursuit_propagator.h"

namespace predator_prey {
namespace {

// Orientation after turning at a constant angular velocity, both in the world frame.
Eigen::Quaterniond Turn(const Eigen::Quaterniond& orientation,
                        const Eigen::Vector3d& angular_velocity_radps, double duration_s) {
  const Eigen::Vector3d half = 0.5 * duration_s * angular_velocity_radps;
  return (Eigen::Quaterniond(1.0, half.x(), half.y(), half.z()) * orientation).normalized();
}

}  // namespace

Eigen::Vector3d PursuitPropagator::BoxForce(const Eigen::Vector3d& position_m) const {
  const double half = options_.box_half_extent_m;
  const Eigen::Vector3d inside = position_m.cwiseMax(-half).cwiseMin(half);
  return options_.box_stiffness_npm * (inside - position_m);
}

Eigen::Vector3d PursuitPropagator::FleeForce(const Pursuit& now) const {
  const Eigen::Vector3d away = now.prey_position_m - now.predator.position_m;
  if (away.norm() >= options_.flee_distance_m) return Eigen::Vector3d::Zero();
  return options_.flee_force_n * away.normalized();
}

void PursuitPropagator::propagate(const ompl::base::State* state,
                                  const ompl::control::Control* control, double duration_s,
                                  ompl::base::State* result) const {
  Pursuit now = ReadState(state);
  const Wrench wrench = ReadControl(control);
  const Eigen::Vector3d predator_force_n = wrench.force_n + BoxForce(now.predator.position_m);
  const Eigen::Vector3d prey_force_n = FleeForce(now) + BoxForce(now.prey_position_m);

  // Semi-implicit Euler: velocities first.
  BodyState& predator = now.predator;
  predator.linear_velocity_mps += duration_s / options_.mass_kg * predator_force_n;
  predator.angular_velocity_radps += duration_s / options_.inertia_kgm2 * wrench.torque_nm;
  now.prey_velocity_mps += duration_s / options_.mass_kg * prey_force_n;
  predator.position_m += duration_s * predator.linear_velocity_mps;
  predator.orientation = Turn(predator.orientation, predator.angular_velocity_radps, duration_s);
  now.prey_position_m += duration_s * now.prey_velocity_mps;
  now.time_s += duration_s;
  WriteState(now, result);
}

}  // namespace predator_prey
