// The metrics of a run, of its folder: metrics.csv, thinned to what one can see, and summary.json.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tcs::report {

// What a run says that a metric came to; none where it had no values, or says nothing of it.
struct MetricFigure {
  std::string from;             // ROBOT/CLIENT, or "scenario"
  std::string asked;            // the figure that counts: the scenario's, else "mean"
  std::optional<double> value;  // of that; of first_time_when seconds
  std::int64_t count = 0;
};

// A metric over time, in the order of time.
struct MetricCurve {
  std::vector<std::pair<double, double>> points;  // s, and the value
};

// By the metrics' names; of a folder without any, none.
[[nodiscard]] std::map<std::string, MetricFigure> ReadMetricFigures(const std::string& folder);

// The same names. The run goes from 0 to `end_s`, which is cut into a few hundred pieces: of each
// the least and the greatest value are there.
[[nodiscard]] std::map<std::string, MetricCurve> ReadMetricCurves(
    const std::string& folder, double end_s, const std::map<std::string, MetricFigure>& metrics);

}  // namespace tcs::report
