// How well a client kept up, as summary.json has it (docs/RESULTS.md).
#pragma once

#include <nlohmann/json.hpp>

#include "coordinator/answers/client_figures.h"

namespace tcs {

// Adds the keys to those of the client. What is not known, or nobody expects of it, is null.
void AddFigures(const ClientFigures& figures, nlohmann::ordered_json& client);

}  // namespace tcs
