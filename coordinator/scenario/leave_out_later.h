// A run that is asked to end early is not judged by expectations that begin only after its end.
#pragma once

#include "coordinator/scenario/scenario.h"

namespace tcs {

// Takes bounds of `expect` that begin after the scenario's duration out of the scenario, and counts
// them (Scenario::not_judged). For --duration the scenario is loaded so.
void LeaveOutLater(Scenario* scenario);

}  // namespace tcs
