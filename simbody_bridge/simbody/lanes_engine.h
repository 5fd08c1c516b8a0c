// Simbody as an engine of islands, side by side: Simbody gives their derivatives, and the steps are
// Runge-Kutta 3's.
#pragma once

#include <memory>
#include <vector>

#include "simbody_bridge/island_engine.h"

namespace tcs {

// `world` has passed CheckWorld. Throws what Simbody throws if it refuses the world all the same.
std::unique_ptr<BodyEngine> MakeLanesEngine(const WorldSpec& world,
                                            const std::vector<std::vector<int>>& islands);

}  // namespace tcs
