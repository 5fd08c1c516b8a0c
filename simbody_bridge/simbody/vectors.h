// Our vectors and poses as Simbody's, and back.
#pragma once

#include <array>

#include "simbody_bridge/model/pose.h"
#include "simbody_bridge/simbody/simbody.h"

namespace tcs {

inline SimTK::Vec3 ToVec3(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }
inline std::array<double, 3> ToArray(const SimTK::Vec3& v) { return {v[0], v[1], v[2]}; }

inline SimTK::Rotation ToRotation(const std::array<double, 4>& xyzw) {
  return SimTK::Rotation(SimTK::Quaternion(xyzw[3], xyzw[0], xyzw[1], xyzw[2]));
}
inline std::array<double, 4> ToXyzw(const SimTK::Rotation& rotation) {
  const SimTK::Quaternion q = rotation.convertRotationToQuaternion();
  return {q[1], q[2], q[3], q[0]};
}

inline SimTK::Transform ToTransform(const Pose& pose) {
  return {ToRotation(pose.orientation_xyzw), ToVec3(pose.position_m)};
}

}  // namespace tcs
