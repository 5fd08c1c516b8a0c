// Finds values that no body can have, and joints that are no tree, before an engine sees a model.
// Pure.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "simbody_bridge/model/robot_model.h"

namespace tcs {

struct ModelFault {
  std::string what;  // one sentence that names the link, the joint or the shape
  int link = -1;     // the fault's link or joint, or neither, for callers that know its line
  int joint = -1;
};

// The first fault of a model; none: the model can be built. The check takes time that grows as the
// model does.
std::optional<ModelFault> CheckModel(const RobotModel& model);

// The fault of a shape ("the radius must be positive and finite, but is -1 m"), without the shape's
// name. Only the world may have planes.
std::optional<std::string> CheckShape(const Shape& shape, bool is_of_world);

// The moments about the principal axes, rising. `inertial` is finite.
std::array<double, 3> PrincipalMoments(const Inertial& inertial);

}  // namespace tcs
