// What the links and joints of a URDF file are, as liburdfdom reads them.
#pragma once

#include <tinyxml2.h>

#include <string>
#include <vector>

#include "coordinator/models/mesh_library.h"
#include "coordinator/models/package_path.h"
#include "coordinator/models/urdf_skeleton.h"
#include "simbody_bridge/model/robot_model.h"

namespace tcs {

// What shapes need that is not in the file.
struct UrdfSurroundings {
  const PackagePath& packages;
  MeshLibrary& meshes;
  double friction;
};

// The skeleton's model with the values of `understood` (UnderstoodPart), of the same file. Throws
// ModelMistake, "PATH:LINE: …", for a mesh that cannot be had and for what only liburdfdom objects
// to. `warnings` gets what is hardly meant.
RobotModel WithValues(const UrdfSkeleton& skeleton, const tinyxml2::XMLDocument& understood,
                      const UrdfSurroundings& surroundings, std::vector<std::string>* warnings);

}  // namespace tcs
