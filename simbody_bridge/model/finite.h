// Whether numbers are numbers.
#pragma once

#include <algorithm>
#include <cmath>

#include "simbody_bridge/model/pose.h"

namespace tcs {

template <class Numbers>
bool AllFinite(const Numbers& numbers) {
  return std::all_of(std::begin(numbers), std::end(numbers),
                     [](double number) { return std::isfinite(number); });
}
inline bool AllFinite(const Pose& pose) {
  return AllFinite(pose.position_m) && AllFinite(pose.orientation_xyzw);
}
inline bool IsPositive(double value) { return std::isfinite(value) && value > 0; }
inline bool IsNonNegative(double value) { return std::isfinite(value) && value >= 0; }

}  // namespace tcs
