// What is known of a body, and what can be done to it. World frame, SI units (REP-103); a body's
// position is its centre of mass.
#pragma once

#include <Eigen/Geometry>

namespace predator_prey {

struct BodyState {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d linear_velocity_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_radps = Eigen::Vector3d::Zero();
};

struct Wrench {
  Eigen::Vector3d force_n = Eigen::Vector3d::Zero();  // at the centre of mass
  Eigen::Vector3d torque_nm = Eigen::Vector3d::Zero();
};

}  // namespace predator_prey
