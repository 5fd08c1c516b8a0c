// Simbody as an engine of islands, by the integrators that it brings: one integrator for each
// island.
#pragma once

#include <memory>
#include <vector>

#include "simbody_bridge/island_engine.h"

namespace tcs {

// `world` has passed CheckWorld. Throws what Simbody throws if it refuses the world all the same.
std::unique_ptr<BodyEngine> MakeIntegratorEngine(const WorldSpec& world,
                                                 const std::vector<std::vector<int>>& islands);

}  // namespace tcs
