// The way from a robot's description, a URDF file, to a RobotModel.
#pragma once

#include <string>
#include <vector>

#include "coordinator/models/mesh_library.h"
#include "coordinator/models/package_path.h"
#include "coordinator/scenario/load_error.h"
#include "simbody_bridge/model/robot_model.h"

namespace tcs {

// What is not in the file.
struct UrdfUse {
  bool has_fixed_base = false;
  double friction = 0.8;  // of all shapes
};

// Loads and checks the URDF file `path` (absolute): CheckModel finds nothing wrong with what it
// returns, unless it be that 0 is no position of a joint: where it starts is not in the file. Links
// and joints are in the order of the file. The first mistake is the error, one sentence beginning
// "PATH:LINE: " ("PATH: " where the file cannot be read at all). `warnings` gets a sentence for
// each kind of thing in the file that is not understood, and for what is hardly meant. Meshes are
// convex hulls. Reads the environment; not for several threads at once.
[[nodiscard]] LoadResult<RobotModel> LoadUrdf(const std::string& path, const UrdfUse& use,
                                              const PackagePath& packages, MeshLibrary* meshes,
                                              std::vector<std::string>* warnings);

}  // namespace tcs
