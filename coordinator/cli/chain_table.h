// The chains of a run from sensors to actuators, for a terminal.
#pragma once

#include <string>
#include <vector>

#include "coordinator/answers/chain_figures.h"

namespace tcs {

// Those that the scenario names, and those that go over several programs; empty, if there is none.
std::string ChainTable(const std::vector<ChainFigures>& chains);

}  // namespace tcs
