// Reading of the folders that `tcsim run` and `tcsim trials` leave.
#pragma once

#include <string>
#include <vector>

#include "coordinator/errors/load_error.h"
#include "coordinator/report/read_run.h"
#include "coordinator/report/results.h"

namespace tcs::report {

// A folder is that of a run (a system with one run), of several trials (a system), or of trials
// over several values (a sweep). Runs that did not go to their end are named in their system; a
// folder without any good run is left out with a warning. The error is one sentence: nothing is
// left, a folder is none of these, or not all folders are of one scenario.
[[nodiscard]] LoadResult<Results> ReadResults(const std::vector<std::string>& folders,
                                              const std::vector<std::string>& bodies,
                                              Distance distance = Distance::kRead);

}  // namespace tcs::report
