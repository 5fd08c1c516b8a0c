// The topics whose other end is the simulation's: the topics of channels of the type `dds`, and the
// clock's. The topics are in shared memory, where a program whose DDS uses sockets never meets
// them.
#pragma once

#include <string>

#include "coordinator/scenario/scenario.h"

namespace tcs {

// For a sentence: "/odom, /wrench and /clock"; the first few of many. Empty: there are none.
[[nodiscard]] std::string NamesOfOwnTopics(const Scenario& scenario);

}  // namespace tcs
