// The figures that the values of one metric come to in a run. A program printed the metric
// (`tcs-metric NAME VALUE`), or the scenario names it. Values have the unit that the program or the
// scenario has in mind.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace tcs {

// The figure that a scenario asks for. `kFirstTimeWhen` is of a condition, whose values are 1 while
// it holds and 0 while not, so that its mean is the share of the time for which it held.
enum class MetricFigure { kLast, kMin, kMax, kMean, kRms, kFirstTimeWhen, kCount };

// The figures' names in scenarios.
inline constexpr std::array<std::string_view, static_cast<std::size_t>(MetricFigure::kCount)>
    kMetricFigureNames = {"last", "min", "max", "mean", "rms", "first_time_when"};

struct MetricFigures {
  std::string from;                          // "ROBOT/CLIENT", or kMetricFromScenario
  MetricFigure asked = MetricFigure::kLast;  // of a scenario's metric
  std::int64_t count = 0;                    // 0: there were no values, and all below is 0
  double last = 0, min = 0, max = 0, mean = 0, rms = 0;
  // When the first value came; of a condition, when it held first. -1: never.
  std::int64_t first_time_ns = -1;
};

inline constexpr std::string_view kMetricFromScenario = "scenario";
// The quantities that the scenario expects to stay within bounds: no figures of the run for people.
inline constexpr std::string_view kMetricFromExpectations = "expect";

// Figures by the metrics' names. Where several clients print one name, or the scenario has it, too,
// the clients' figures are under ROBOT/CLIENT/NAME.
using MetricsOfRun = std::map<std::string, MetricFigures>;

}  // namespace tcs
