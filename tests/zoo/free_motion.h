// Robots in smooth motion, which other programs can be asked about: nothing touches, stops or rubs,
// and nothing mimics.
#pragma once

#include <functional>
#include <random>
#include <string>

#include "shm/virtual_time.h"
#include "simbody_bridge/dynamics.h"

namespace tcs::zoo {

// From where `random` says; a free base is at rest.
RobotModel SmoothModel(RobotModel model, std::mt19937_64& random);

struct Apart {
  double most = 0;   // rad or m, of all joints that have one coordinate
  double moved = 0;  // by which the joint that has moved most is elsewhere than at the start
};
// After that time on the engine, whose steps are short, beside where others have its joints.
Apart ApartFrom(const std::function<double(const Joint& joint)>& position_of,
                const RobotModel& model, EngineKind engine, VirtualDuration duration);

}  // namespace tcs::zoo
