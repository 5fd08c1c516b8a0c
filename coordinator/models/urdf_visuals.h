// The looks of the links of a URDF file: the <visual> elements and their colours.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "simbody_bridge/model/shape.h"

namespace tcs {

// A mesh that is shown and never collides: it is named here, not read.
struct MeshFile {
  std::string name;  // as the file has it
  std::array<double, 3> scale{1, 1, 1};
};

struct Visual {
  std::variant<BoxShape, SphereShape, CylinderShape, MeshFile> geometry;
  Pose pose;                                           // in the link's frame
  std::optional<std::array<double, 4>> colour_rgba{};  // 0 … 1
};

// The visuals of each link of the file, by name; of `expanded`, which xacro has made of the file,
// unless that is empty. Neither the physics nor any program depends on how a robot looks: a part
// that cannot be understood here, or the file as a whole, is left out without a word.
[[nodiscard]] std::map<std::string, std::vector<Visual>> ReadVisuals(
    const std::string& path, const std::string& expanded = {});

}  // namespace tcs
