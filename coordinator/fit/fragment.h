// The fitted costs as a piece of a scenario, for `tcsim run --overlay`.
#pragma once

#include <string>
#include <vector>

#include "coordinator/fit/fit_table.h"

namespace tcs::fit {

// YAML. Clients without costs are left out: they keep the scenario's.
[[nodiscard]] std::string FragmentOf(const MeasuredRun& run, const std::vector<ClientFit>& fits);

}  // namespace tcs::fit
