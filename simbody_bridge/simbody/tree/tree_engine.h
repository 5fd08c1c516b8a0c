// Simbody as an engine of islands of models: Simbody gives their derivatives, and the steps are
// Runge-Kutta 3's, of the exponential kind where servos act.
#pragma once

#include <memory>
#include <vector>

#include "simbody_bridge/model_engine.h"

namespace tcs {

// Throws DynamicsError if Simbody refuses the models, or where world.integrator asks for another
// method.
std::unique_ptr<ModelEngine> MakeTreeEngine(const WorldSpec& world,
                                            const std::vector<std::vector<int>>& islands);

}  // namespace tcs
