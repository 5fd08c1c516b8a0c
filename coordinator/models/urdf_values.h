// The values of the links and joints of a URDF file, as liburdfdom reads them.
#pragma once

#include <tinyxml2.h>

#include <string>

#include "coordinator/models/mesh_library.h"
#include "coordinator/models/package_path.h"
#include "coordinator/models/urdf_notes.h"
#include "coordinator/models/urdf_skeleton.h"
#include "simbody_bridge/model/robot_model.h"

namespace tcs {

// The things that shapes need and that are not in the file.
struct UrdfSurroundings {
  const PackagePath& packages;
  MeshLibrary& meshes;
  std::string described_in;  // the file
};

// The skeleton's model with the values of `understood`, the document that it was made of. A value
// that liburdfdom objects to, and a mesh that cannot be had, is a mistake in `notes`; a value that
// is hardly meant, or mended, is a warning there.
RobotModel WithValues(const UrdfSkeleton& skeleton, const tinyxml2::XMLDocument& understood,
                      const UrdfSurroundings& surroundings, UrdfNotes* notes);

}  // namespace tcs
