// The kinds of joints by name, as URDF and scene.json have them.
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "simbody_bridge/model/robot_model.h"

namespace tcs {

inline constexpr std::array<std::pair<std::string_view, JointKind>, 6> kJointKinds = {{
    {"fixed", JointKind::kFixed},
    {"revolute", JointKind::kRevolute},
    {"continuous", JointKind::kContinuous},
    {"prismatic", JointKind::kPrismatic},
    {"planar", JointKind::kPlanar},
    {"floating", JointKind::kFloating},
}};

constexpr std::string_view NameOf(JointKind kind) {
  for (const auto& [name, each] : kJointKinds) {
    if (each == kind) return name;
  }
  return {};
}

}  // namespace tcs
