// Whether each client kept up, as a table for the end of a run.
#pragma once

#include <string>
#include <vector>

#include "coordinator/tasks/coordinator.h"

namespace tcs {

[[nodiscard]] std::string ClientTable(const std::vector<ClientReport>& clients);

}  // namespace tcs
