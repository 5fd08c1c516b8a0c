// The one symbol of libtcs_physics.so.
#pragma once

#include "simbody_bridge/dynamics.h"

namespace tcs {

// As MakeDynamics(); the caller owns what it returns. Both sides are of one build.
using MakeDynamicsFunction = Dynamics*(const WorldSpec& world);

inline constexpr const char* kMakeDynamicsName = "tcs_make_dynamics";

}  // namespace tcs
