// The picture of a measure against a key: medians as curves with a mark at each value that was
// tried, and around them the band that 10 % and 90 % of the trials lie below.
#pragma once

#include <vector>

#include "coordinator/report/figure.h"
#include "coordinator/report/measure_data.h"

namespace tcs::report {

// Panels stand beside each other where there is room, with the same axes.
[[nodiscard]] Drawing DrawMeasure(const MeasurePlotData& data, int width);

struct MeasureSpread {
  double low = 0, median = 0, high = 0;  // 10 %, 50 % and 90 %
};
// The spread of at least one value.
[[nodiscard]] MeasureSpread MeasureSpreadOf(std::vector<double> values);

}  // namespace tcs::report
