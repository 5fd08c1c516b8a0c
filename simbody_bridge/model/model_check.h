// Says what no body can have, and what is no tree, before an engine sees a model. Pure.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "simbody_bridge/model/robot_model.h"

namespace tcs {

struct ModelFault {
  std::string what;  // one sentence that names the link, the joint or the shape
  int link = -1;     // what it is about, for whoever knows the line: one of the two, or neither
  int joint = -1;
};

// The first fault of a model that there is; none: it can be built. It takes time that grows as the
// model does.
std::optional<ModelFault> CheckModel(const RobotModel& model);

// What is wrong with a shape, without its name ("the radius must be positive and finite, but is -1
// m"). Planes only of the world.
std::optional<std::string> CheckShape(const Shape& shape, bool is_of_world);

// The moments about the principal axes, rising. `inertial` is finite.
std::array<double, 3> PrincipalMoments(const Inertial& inertial);

}  // namespace tcs
