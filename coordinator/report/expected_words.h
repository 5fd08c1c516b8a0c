// Whether runs came to what their scenario expects, as a page tells of it after its verdict.
#pragma once

#include <string>
#include <vector>

#include "coordinator/report/results.h"

namespace tcs::report {

// How many expectations hold; of several runs, in all of them. Empty: nothing is expected.
[[nodiscard]] std::string ExpectedSentence(const System& system);

// A sentence for each expectation that does not hold: its outcome, and in how many of several runs
// it held.
[[nodiscard]] std::vector<std::string> NotAsExpected(const System& system);

}  // namespace tcs::report
