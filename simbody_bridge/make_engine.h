// The one place that knows all engines.
#pragma once

#include <memory>

#include "simbody_bridge/dynamics.h"

namespace tcs {

// All bodies in one system of the engine that world.integrator names, which is integrated as a
// whole at each call of AdvanceTo. `world` has passed CheckWorld. Throws DynamicsError if the
// engine refuses it all the same.
std::unique_ptr<Dynamics> MakeEngine(const WorldSpec& world);

}  // namespace tcs
