// Vectors and quaternions (x, y, z, w) in JSON.
#pragma once

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

namespace quadrotor {

using Eigen::Quaterniond;
using Eigen::Vector3d;

inline constexpr double kGravity = 9.81;

inline Vector3d VectorOf(const nlohmann::json& list) {
  return {list.at(0).get<double>(), list.at(1).get<double>(), list.at(2).get<double>()};
}
inline nlohmann::json JsonOf(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

inline Quaterniond QuaternionOf(const nlohmann::json& list) {
  return Quaterniond(list.at(3).get<double>(), list.at(0).get<double>(), list.at(1).get<double>(),
                     list.at(2).get<double>());
}
inline nlohmann::json JsonOf(const Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }

}  // namespace quadrotor
