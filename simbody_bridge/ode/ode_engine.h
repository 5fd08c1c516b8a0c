// ODE, the Open Dynamics Engine, as an engine of islands: the engine of Gazebo, and so the baseline
// that the paper compares with. Semi-implicit Euler by steps of one length.
//
// The engine lives below simbody_bridge/, whose name is older than the second engine: the
// interface, the checks of a world, the islands and the walls of a region stand there and are
// shared.
#pragma once

#include <memory>
#include <vector>

#include "simbody_bridge/island_engine.h"

namespace tcs {

// `world` has passed CheckWorld. Throws DynamicsError if libode cannot be used.
std::unique_ptr<BodyEngine> MakeOdeEngine(const WorldSpec& world,
                                          const std::vector<std::vector<int>>& islands);

}  // namespace tcs
