// Arithmetic of vectors of three numbers, and of quaternions.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace tcs {

inline std::array<double, 3> Minus(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline double Dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline std::array<double, 3> Cross(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Of quaternions in whichever order.
inline double NormOf(std::span<const double, 4> q) {
  return std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
}
inline void Normalise(std::span<double, 4> q) {
  const double norm = NormOf(q);
  for (double& number : q) number /= norm;
}

// `v` turned by the quaternion x y z w, which has unit length.
inline std::array<double, 3> TurnedBy(const std::array<double, 4>& q,
                                      const std::array<double, 3>& v) {
  const std::array<double, 3> axis = {q[0], q[1], q[2]};
  const std::array<double, 3> once = Cross(axis, v), twice = Cross(axis, once);
  std::array<double, 3> turned;
  for (std::size_t i = 0; i < 3; ++i) turned[i] = v[i] + 2 * (q[3] * once[i] + twice[i]);
  return turned;
}

}  // namespace tcs
