// Figures of one's own: what programs print as metrics, and what scenarios name.
#pragma once

#include <optional>
#include <vector>

#include "coordinator/report/figure.h"
#include "coordinator/report/results.h"
#include "coordinator/report/sections.h"

namespace tcs::report {

// Each metric over time, of each system's first run. None where there are no metrics.
[[nodiscard]] std::optional<Figure> MetricsOverTime(const Results& results);

// What each metric came to, over all runs of a system.
[[nodiscard]] std::optional<Section> MetricsSection(const Results& results);

}  // namespace tcs::report
