// The logs that an earlier run has left in a folder that another run is about to write to.
#pragma once

#include <string>

#include "coordinator/scenario/scenario.h"

namespace tcs {

// Removes the logs of clients that the earlier run had, by its summary.json or unfinished.json, and
// this scenario does not have: nobody is to take these logs for this run's. Removes nothing from a
// folder without a run.
void RemoveLogsOfEarlierRun(const std::string& folder, const Scenario& scenario);

}  // namespace tcs
