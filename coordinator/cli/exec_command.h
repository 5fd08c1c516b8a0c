// `tcsim exec`.
#pragma once

#include <string>
#include <vector>

#include "coordinator/core/coordinator.h"

namespace tcs {

// Runs `command` alone on a computer of `cores` cores of the given speed, without dynamics; the
// exit status is the command's own.
int ExecCommand(const std::vector<std::string>& command, double speed, int cores,
                const RunOptions& options);

}  // namespace tcs
