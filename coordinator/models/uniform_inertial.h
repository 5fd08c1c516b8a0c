// The inertia of a body of one shape whose mass is spread evenly.
#pragma once

#include "simbody_bridge/model/robot_model.h"

namespace tcs {

// The inertia of the volume of `geometry`, a plane excepted; a mesh has the volume of its
// triangles, and its centre of mass need not be its origin. Sizes and mass are positive.
Inertial UniformInertial(const Geometry& geometry, double mass_kg);

}  // namespace tcs
