// Steps and signs without a jump, whose derivatives have none either: error control takes them by
// steps as long as they are wide.
#pragma once

#include <algorithm>
#include <cmath>

namespace tcs {

// From 0 at 0 to 1 at 1.
inline double SmoothStep(double x) {
  const double inside = std::clamp(x, 0.0, 1.0);
  return inside * inside * (3 - 2 * inside);
}

// From -1 at -1 to 1 at 1, steepest at 0.
inline double SmoothSign(double x) {
  const double inside = std::clamp(x, -1.0, 1.0);
  return inside * (1.5 - 0.5 * inside * inside);
}
inline double SlopeOfSmoothSign(double x) {
  const double inside = std::clamp(x, -1.0, 1.0);
  return 1.5 * (1 - inside * inside);
}

}  // namespace tcs
