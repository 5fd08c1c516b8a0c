// Lets an engine take the steps that several islands need, and says in one sentence what went
// wrong.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "simbody_bridge/island_engine.h"

namespace tcs {

// Says whose motion it is that has diverged in a state of the island.
using WhoDiverged = std::function<std::string(int island, std::span<const double> state)>;

// The remedy for the part that the engine suspects, with a semicolon before it; empty: not known.
std::string RemedyFor(IslandEngine& engine, int island);

// Throws DynamicsError.
void TakeSteps(IslandEngine& engine, std::span<IslandStep* const> steps, const WhoDiverged& who);
// Throws DynamicsError unless the island's state at `t` is one to go on from.
void CheckState(IslandEngine& engine, int island, std::span<const double> state, VirtualTime t,
                const WhoDiverged& who);

}  // namespace tcs
