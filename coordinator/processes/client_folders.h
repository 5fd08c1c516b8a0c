// The clients' part of a run's results before the clients start: their folders, and no log of an
// earlier run.
#pragma once

#include <string>

#include "coordinator/scenario/scenario.h"
#include "coordinator/tasks/coordinator.h"

namespace tcs {

// Empty on success, else one sentence.
[[nodiscard]] std::string PrepareFolders(const Scenario& scenario, const RunOptions& options);

}  // namespace tcs
