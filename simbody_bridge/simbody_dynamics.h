// Simbody behind the Dynamics interface.
#pragma once

#include <memory>

#include "simbody_bridge/dynamics.h"

namespace tcs {

// `world` has passed CheckWorld. Throws DynamicsError if Simbody refuses it all the same.
std::unique_ptr<Dynamics> MakeSimbodyDynamics(const WorldSpec& world);

}  // namespace tcs
