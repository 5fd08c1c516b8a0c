#pragma once

#include <optional>
#include <string>

#include "simbody_bridge/model/robot_model.h"

namespace tcs::zoo {

// How far the joints of the robot in the file `urdf`, read as `model`, are from where DART has them
// after 1 s of smooth motion (free_motion.h); `packages` is the folder of the packages. None: DART
// is not there, cannot read the file, or finds another place with four times as many steps.
std::optional<double> DifferenceToDart(const std::string& urdf, const std::string& packages,
                                       const RobotModel& model);

}  // namespace tcs::zoo
