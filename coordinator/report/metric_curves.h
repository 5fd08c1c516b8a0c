// The metrics of a run, of its folder: metrics.csv, thinned to what one can see, and summary.json.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tcs::report {

// The figure that a run gives for a metric; none where the metric had no values, or the run says
// nothing of it.
struct MetricFigure {
  std::string from;             // ROBOT/CLIENT, or "scenario"
  std::string asked;            // the figure that counts: the scenario's, else "mean"
  std::optional<double> value;  // of that figure; of first_time_when seconds
  std::int64_t count = 0;
};

// A metric over time, in the order of time.
struct MetricCurve {
  std::vector<std::pair<double, double>> points;  // s, and the value
};

// The figures by the metrics' names; empty for a folder without metrics.
[[nodiscard]] std::map<std::string, MetricFigure> ReadMetricFigures(const std::string& folder);

// The curves, by the same names. The run goes from 0 to `end_s`, which is cut into a few hundred
// pieces: each piece has its least and its greatest value.
[[nodiscard]] std::map<std::string, MetricCurve> ReadMetricCurves(
    const std::string& folder, double end_s, const std::map<std::string, MetricFigure>& metrics);

}  // namespace tcs::report
