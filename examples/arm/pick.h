// How the tool takes a part off the running belt: down to it, along with it while it is sucked on,
// and up again.
#pragma once

#include <optional>

#include "examples/arm/inverse_kinematics.h"
#include "examples/arm/trajectory.h"

namespace arm {

struct Part {
  int number;
  double x_m, y_m, yaw_rad;  // when it was seen
  double seen_s, belt_mps;

  double YAt(double seconds) const { return y_m + belt_mps * (seconds - seen_s); }
  // When it comes there.
  double TimeAt(double y) const { return seen_s + (y - y_m) / belt_mps; }
};

inline constexpr double kDownS = 0.6;  // from the beginning until the tool is at the part

// The motion that has the tool at the part at the time `at_s`; from rest to rest. None where the
// arm does not reach, or would meet something. The last joint begins near that angle.
std::optional<Points> Pick(const Part& part, double at_s, double near_rad);

}  // namespace arm
