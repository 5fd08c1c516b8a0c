// The meshes of a scenario, each read once.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "simbody_bridge/model/shape.h"

namespace tcs {

class MeshLibrary {
 public:
  // The convex hull of the mesh in the file `path` (STL, OBJ, COLLADA, glTF), scaled along its axes
  // by these numbers. The hull has 512 vertices at most. A flat mesh becomes a thin plate; null:
  // the mesh is a line or a point. Throws ModelMistake, "PATH: …", for a file that is no mesh, is
  // larger than 64 MiB, or takes too long to read.
  std::shared_ptr<const Mesh> Take(const std::string& path, const std::array<double, 3>& scale);
  // Whether the mesh in that file, which has been taken so scaled, is flat.
  bool IsFlat(const std::string& path, const std::array<double, 3>& scale) const;

 private:
  using Use = std::pair<std::string, std::array<double, 3>>;  // a file, and its scale

  std::map<std::string, Mesh> read_;  // hulls, before scaling
  std::set<std::string> flat_files_;  // files whose hulls are plates
  std::map<Use, std::shared_ptr<const Mesh>> scaled_;
  std::set<Use> flat_;  // uses that scaling has made plates, or that are but for rounding
};

}  // namespace tcs
