// The output of `tcsim fit`: each client's costs, and what these charge beside what was measured.
#pragma once

#include <string>
#include <vector>

#include "coordinator/fit/costs.h"
#include "coordinator/fit/measured_run.h"

namespace tcs::fit {

struct ClientFit {
  std::string client;  // ROBOT/CLIENT
  Costs costs;
};

// The fits of all clients, in the order of their names.
[[nodiscard]] std::vector<ClientFit> FitAll(const MeasuredRun& run);

// For a terminal; ends with a line's end.
[[nodiscard]] std::string FitTable(const MeasuredRun& run, const std::vector<ClientFit>& fits);

// One sentence for each client whose calls and allocations do not tell how long it computes.
[[nodiscard]] std::vector<std::string> FitWarnings(const MeasuredRun& run,
                                                   const std::vector<ClientFit>& fits);

}  // namespace tcs::fit
