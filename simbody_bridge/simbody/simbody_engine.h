// Simbody as an engine of islands.
#pragma once

#include <memory>
#include <vector>

#include "simbody_bridge/island_engine.h"

namespace tcs {

// The engine, by the method and the steps that world.integrator names. `world` has passed
// CheckWorld. Throws DynamicsError if Simbody refuses the world all the same.
std::unique_ptr<BodyEngine> MakeSimbodyEngine(const WorldSpec& world,
                                              const std::vector<std::vector<int>>& islands);

}  // namespace tcs
