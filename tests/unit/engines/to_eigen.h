// Vectors and poses as Eigen and DART have them.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "simbody_bridge/model/pose.h"

namespace tcs {

inline Eigen::Vector3d ToEigen(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

inline Eigen::Isometry3d ToEigen(const Pose& pose) {
  const auto [x, y, z, w] = pose.orientation_xyzw;
  Eigen::Isometry3d at = Eigen::Isometry3d::Identity();
  at.linear() = Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
  at.translation() = ToEigen(pose.position_m);
  return at;
}

}  // namespace tcs
