// What an earlier run has left in a folder that another one is about to write to.
#pragma once

#include <string>

#include "coordinator/scenario/scenario.h"

namespace tcs {

// Removes the logs of clients that the earlier run had, by its summary.json or unfinished.json, and
// this scenario does not: nobody is to take them for this run's. Of a folder without a run nothing.
void RemoveLogsOfEarlierRun(const std::string& folder, const Scenario& scenario);

}  // namespace tcs
