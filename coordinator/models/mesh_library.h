// The meshes of a scenario, each read once.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "simbody_bridge/model/shape.h"

namespace tcs {

class MeshLibrary {
 public:
  // The convex hull of the mesh in the file `path` (STL, OBJ, COLLADA), scaled along its axes by
  // numbers other than 0. It has 512 vertices at most. Throws ModelMistake, "PATH: …": what is no
  // mesh, is flat, is larger than 64 MiB, or takes too long to read.
  std::shared_ptr<const Mesh> Take(const std::string& path, const std::array<double, 3>& scale);

 private:
  std::map<std::string, Mesh> read_;  // hulls, before scaling
  std::map<std::pair<std::string, std::array<double, 3>>, std::shared_ptr<const Mesh>> scaled_;
};

}  // namespace tcs
