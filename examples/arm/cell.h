// What stands around the arm, and where parts come along: the numbers of scenario.yaml, in metres.
#pragma once

#include <array>

#include "examples/arm/arm_model.h"

namespace arm {

struct Box {
  Vector3d lower, upper;
};

inline Box BoxAt(const Vector3d& middle, const Vector3d& edges) {
  return {middle - edges / 2, middle + edges / 2};
}

inline const std::array<Box, 6> kObstacles = {{
    BoxAt({0, 0, 0.25}, {0.22, 0.22, 0.5}),      // the pedestal
    BoxAt({0.5, 0, 0.25}, {0.24, 4, 0.5}),       // the belt
    BoxAt({0.5, -0.62, 1.0}, {0.5, 0.1, 0.1}),   // the bridge with the camera
    BoxAt({0.3, 0.45, 0.6}, {0.08, 0.08, 1.2}),  // a post
    BoxAt({0.0, 0.62, 0.25}, {0.3, 0.3, 0.5}),   // the bin
    BoxAt({0.0, 0.2, -0.05}, {4, 6, 0.1}),       // the floor
}};

// The belt runs along y. A part's place is the middle of its top.
inline constexpr double kBeltX = 0.5, kPartTop = 0.55;
inline constexpr double kCameraY = -0.9, kFirstY = -0.4, kLastY = 0.2, kGoneY = 0.6;

// Where the tool lets go of a part.
inline const Vector3d kOverBin{0.0, 0.62, 0.66};

}  // namespace arm
