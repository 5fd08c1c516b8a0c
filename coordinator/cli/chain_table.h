// The chains of a run from sensors to actuators, for a terminal.
#pragma once

#include <string>
#include <vector>

#include "coordinator/answers/chain_figures.h"

namespace tcs {

// The chains that the scenario names, and the chains that go over several programs; empty, if there
// is no such chain.
std::string ChainTable(const std::vector<ChainFigures>& chains);

}  // namespace tcs
