// Mends masses and inertias in files that no body has, or that nothing can be moved with.
#pragma once

#include <array>
#include <cstddef>
#include <functional>

#include "coordinator/models/urdf_notes.h"
#include "simbody_bridge/model/robot_model.h"

namespace tcs {

// Changes `model`, a tree whose joints have axes, so that each body has a mass and an inertia that
// a body can have. A body consists of the links that are fixed to each other: a link that is fixed
// to another one only adds to it. A broken value becomes the nearest that can be; a missing value
// becomes the least with which engines integrate well. Each change of a kind is in `notes`;
// rounding is mended without a word. `line_of` tells where a link, by index, stands.
void MendMasses(RobotModel* model, const std::function<int(std::size_t)>& line_of,
                UrdfNotes* notes);

// The moments, rising, of the nearest inertia that a body of volume can have: no moment exceeds the
// sum of the two others.
std::array<double, 3> NearestMoments(const std::array<double, 3>& moments);

}  // namespace tcs
