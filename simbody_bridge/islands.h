// Bodies that cannot touch or pull each other are integrated apart: each island is a Dynamics of
// its own, with a clock of its own.
#pragma once

#include <vector>

#include "simbody_bridge/dynamics.h"

namespace tcs {

// The bodies of each island, as indices into `world.bodies`. Free bodies know walls and gravity,
// but not each other: each is an island.
std::vector<std::vector<int>> IslandsOf(const WorldSpec& world);

}  // namespace tcs
