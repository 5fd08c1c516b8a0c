// Which links of a model are in each other where it starts. Pure geometry.
#pragma once

#include <utility>
#include <vector>

#include "simbody_bridge/model/robot_model.h"

namespace tcs {

// Where each link is at the start, in the world. `model` has passed CheckModel.
std::vector<Pose> StartingPoses(const RobotModel& model);

// Pairs of links, by index, the lower one first, that would push each other apart at once: they are
// of different bodies that no joint joins, and some of their shapes are in each other by more than
// a millimetre. Links whose pair the model ignores are not among them.
std::vector<std::pair<int, int>> OverlappingLinks(const RobotModel& model);

}  // namespace tcs
