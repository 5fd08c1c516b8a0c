// The inertia of a body of one shape whose mass is spread evenly.
#pragma once

#include "simbody_bridge/model/robot_model.h"

namespace tcs {

// Of the volume of `geometry`, a plane excepted; of a mesh that of its triangles, whose centre of
// mass need not be its origin. Sizes and mass are positive.
Inertial UniformInertial(const Geometry& geometry, double mass_kg);

}  // namespace tcs
