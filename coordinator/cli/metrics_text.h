// The metrics of a run at its end: as a table for people, and in summary.json (docs/RESULTS.md).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "coordinator/metrics/metric_figures.h"

namespace tcs {

// Empty without metrics. Of very many metrics the first ones, and how many more there are.
[[nodiscard]] std::string MetricsTable(const MetricsOfRun& metrics);

// A figure that there is nothing to say of (no values, never) is null.
[[nodiscard]] nlohmann::ordered_json MetricsJson(const MetricsOfRun& metrics);

}  // namespace tcs
