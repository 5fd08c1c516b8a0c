// The principal axes of an inertia. Pure.
#pragma once

#include <array>

namespace tcs {

struct PrincipalAxes {
  std::array<double, 3> moments;  // rising
  // The unit vector of each moment.
  std::array<std::array<double, 3>, 3> axes;
};

// Of a symmetric matrix of finite numbers.
PrincipalAxes PrincipalAxesOf(const std::array<std::array<double, 3>, 3>& inertia);

}  // namespace tcs
