// A run that is asked to end early is not judged by what is expected only then.
#pragma once

#include "coordinator/scenario/scenario.h"

namespace tcs {

// Takes bounds of `expect` that begin after the scenario's duration out of it, and counts them
// (Scenario::not_judged). For --duration the scenario is loaded so.
void LeaveOutLater(Scenario* scenario);

}  // namespace tcs
