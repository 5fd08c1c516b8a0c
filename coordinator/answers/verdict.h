// The findings on a run, in sentences, worst first: deadlines that were missed, and why, data that
// was old or never read. Nothing is said of clients that met all their deadlines. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/answers/chain_figures.h"
#include "coordinator/answers/client_figures.h"

namespace tcs {

struct ClientOutcome {
  std::string name;
  std::optional<int> priority;  // none: deadlines order the threads
  ClientFigures figures;
};

std::vector<std::string> VerdictOn(const std::vector<ClientOutcome>& clients,
                                   const std::vector<ChainFigures>& chains, std::int64_t end_ns);

// At most five sentences; the last sentence says how many more there are.
std::vector<std::string> Shortened(std::vector<std::string> verdict);

}  // namespace tcs
