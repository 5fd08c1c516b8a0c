// The metrics of a run at its end: as a table for people, and in summary.json (docs/RESULTS.md).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "coordinator/metrics/metric_figures.h"

namespace tcs {

// Empty without metrics. Of very many the first, and how many there are more.
[[nodiscard]] std::string MetricsTable(const MetricsOfRun& metrics);

// What there is nothing to say of (no values, never) is null.
[[nodiscard]] nlohmann::ordered_json MetricsJson(const MetricsOfRun& metrics);

}  // namespace tcs
