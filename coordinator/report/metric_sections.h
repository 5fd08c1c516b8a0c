// Figures of the user's own: metrics that programs print, and metrics that scenarios name.
#pragma once

#include <optional>
#include <vector>

#include "coordinator/report/figure.h"
#include "coordinator/report/results.h"
#include "coordinator/report/sections.h"

namespace tcs::report {

// Each metric over time, of each system's first run. None where there are no metrics.
[[nodiscard]] std::optional<Figure> MetricsOverTime(const Results& results);

// The result of each metric, over all runs of a system.
[[nodiscard]] std::optional<Section> MetricsSection(const Results& results);

}  // namespace tcs::report
