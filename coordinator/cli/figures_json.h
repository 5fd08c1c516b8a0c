// How well a client kept up, as summary.json has it (docs/RESULTS.md).
#pragma once

#include <nlohmann/json.hpp>

#include "coordinator/answers/chain_figures.h"
#include "coordinator/answers/client_figures.h"

namespace tcs {

// Adds the keys to those of the client. A figure that is not known, or that nobody expects of the
// client, is null.
void AddFigures(const ClientFigures& figures, nlohmann::ordered_json& client);

// A chain, by its name.
nlohmann::ordered_json ChainJson(const ChainFigures& chain);

}  // namespace tcs
