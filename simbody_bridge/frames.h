// Vectors in the frames of the world and of a body.
#pragma once

#include <array>
#include <cstddef>

namespace tcs {

// A world vector along the axes of a body with the orientation `q`.
inline std::array<double, 3> InBody(const std::array<double, 4>& q,
                                    const std::array<double, 3>& v) {
  const auto cross = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return std::array<double, 3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                 a[0] * b[1] - a[1] * b[0]};
  };
  const std::array<double, 3> axis = {-q[0], -q[1], -q[2]};
  const std::array<double, 3> once = cross(axis, v), twice = cross(axis, once);
  std::array<double, 3> turned;
  for (std::size_t i = 0; i < 3; ++i) turned[i] = v[i] + 2 * (q[3] * once[i] + twice[i]);
  return turned;
}

// The other way round: a vector along the body's axes.
inline std::array<double, 3> InWorld(const std::array<double, 4>& q,
                                     const std::array<double, 3>& v) {
  return InBody({-q[0], -q[1], -q[2], q[3]}, v);
}

}  // namespace tcs
