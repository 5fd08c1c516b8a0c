// ODE, the Open Dynamics Engine, behind the Dynamics interface: the engine of Gazebo, and so the
// baseline that the paper compares with.
//
// It lives below simbody_bridge/, whose name is older than the second engine: the interface, the
// checks of a world, the order of commands and the walls of a region stand there and are shared.
#pragma once

#include <memory>

#include "simbody_bridge/dynamics.h"

namespace tcs {

// `world` has passed CheckWorld. Throws DynamicsError if libode cannot be used.
std::unique_ptr<Dynamics> MakeOdeDynamics(const WorldSpec& world);

}  // namespace tcs
