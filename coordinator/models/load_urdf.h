// The way from a robot's description, a URDF file, to a RobotModel.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "coordinator/errors/load_error.h"
#include "coordinator/models/mesh_library.h"
#include "coordinator/models/package_path.h"
#include "coordinator/models/urdf_notes.h"
#include "simbody_bridge/model/robot_model.h"

namespace tcs {

// Settings of a model that are not in the file.
struct UrdfUse {
  bool has_fixed_base = false;
  // The friction of all shapes; none: the file's own value, else 0.8.
  std::optional<double> friction{};
  // The arguments of a file of xacro, by name.
  std::map<std::string, std::string> xacro_arguments{};
};

struct LoadedUrdf {
  RobotModel model;
  std::string expanded;  // the text that xacro has made of the file; empty: it is no file of xacro
};

// Loads and checks the URDF file `path` (absolute): CheckModel finds nothing wrong with the
// returned model, unless it be that 0 is no position of a joint: where a joint starts is not in the
// file. Links and joints are in the order of the file. A file that the field's other tools load is
// loaded, and `remarks` says what was mended. Otherwise the function returns the mistakes, as far
// as they can be seen at once: each a sentence beginning "PATH:LINE: " ("PATH: " where the file
// cannot be read at all). A base that has no mass is fixed. Meshes are convex hulls. A file of
// xacro is expanded by the machine's `xacro`, if there is one. Reads the environment; not for
// several threads at once.
[[nodiscard]] std::variant<LoadedUrdf, std::vector<LoadError>> LoadUrdf(const std::string& path,
                                                                        const UrdfUse& use,
                                                                        const PackagePath& packages,
                                                                        MeshLibrary* meshes,
                                                                        UrdfRemarks* remarks);

}  // namespace tcs
