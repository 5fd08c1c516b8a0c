// Lets an engine take the steps that several islands need, and says in one sentence what went
// wrong.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "simbody_bridge/island_engine.h"

namespace tcs {

// Throws DynamicsError. `who` says whose motion has diverged in a step.
void TakeSteps(IslandEngine& engine, std::span<IslandStep* const> steps,
               const std::function<std::string(const IslandStep&)>& who);

}  // namespace tcs
