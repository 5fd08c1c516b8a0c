// A measure of trials against a key that was varied: which curves there are, and of which trials.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/measures/measure.h"
#include "coordinator/report/results.h"

namespace tcs::report {

// A user's request; empty where tcs is to choose.
struct MeasureRequest {
  std::vector<std::string> measures;
  std::string against;
};

struct MeasurePoint {
  std::string label;           // the value as it was given
  double at = 0;               // as a number, durations in seconds; else its place
  std::vector<double> values;  // one for each trial; at least one
};

struct MeasureCurve {
  std::string name;  // empty where there is only one
  int colour = 0;
  std::vector<MeasurePoint> points;  // by `at`
};

// Curves that share a plot.
struct MeasurePanel {
  std::string title;  // empty where there is only one
  std::vector<MeasureCurve> curves;
};

struct MeasurePlotData {
  std::string measure, against;
  MeasureUnit unit = MeasureUnit::kNumber;
  bool is_numeric = true;  // else values are places, in their order
  std::string curves_are;  // the key that the names of curves are values of, or empty
  // All values that were tried, also where no trial has the measure: a missing value is to be seen.
  std::vector<std::pair<double, std::string>> tried;
  std::vector<MeasurePanel> panels;
  std::size_t left_out = 0;        // panels beyond what can be shown
  std::size_t without_value = 0;   // trials that do not have the measure
  std::optional<double> deadline;  // of response times, if all trials had the same
};

// A plot for each measure asked for, or chosen: the greatest shares of missed deadlines, else the
// greatest response times; against the key asked for, or else each sweep's key, and for a grid the
// processor's speed or the key with the most values. Empty where nothing was varied.
[[nodiscard]] std::vector<MeasurePlotData> MeasurePlots(const Results& results,
                                                        const MeasureRequest& request);

// Why a request cannot be met; empty if it can.
[[nodiscard]] std::string WhyNoMeasure(const Results& results, const MeasureRequest& request);

}  // namespace tcs::report
