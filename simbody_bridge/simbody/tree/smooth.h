// A step without a jump, whose derivative has none either: error control takes it by steps as long
// as it is wide.
#pragma once

#include <algorithm>
#include <cmath>

namespace tcs {

// From 0 at 0 to 1 at 1.
inline double SmoothStep(double x) {
  const double inside = std::clamp(x, 0.0, 1.0);
  return inside * inside * (3 - 2 * inside);
}

}  // namespace tcs
