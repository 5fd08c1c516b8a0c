// MuJoCo as an engine of islands: Runge-Kutta 4 by steps of one length, and MuJoCo's own soft
// contact. Optional: CMake looks for it, and without it the functions say so.
#pragma once

#include <memory>
#include <vector>

#include "simbody_bridge/model_engine.h"

namespace tcs {

// `world` has passed CheckWorld. The functions throw DynamicsError if MuJoCo refuses the world all
// the same, or where this build has no MuJoCo.
std::unique_ptr<ModelEngine> MakeMujocoModels(const WorldSpec& world,
                                              const std::vector<std::vector<int>>& islands);
std::unique_ptr<BodyEngine> MakeMujocoBodies(const WorldSpec& world,
                                             const std::vector<std::vector<int>>& islands);

}  // namespace tcs
