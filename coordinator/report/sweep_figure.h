// The effect of a value: the mean of each trial as a dot, per value the median and the quartiles of
// the means.
#pragma once

#include <string>
#include <vector>

#include "coordinator/report/figure.h"

namespace tcs::report {

struct SweepPoint {
  std::string label;
  double value = 0;
  std::vector<double> means;  // one per trial; at least one
};

struct SweepSeries {
  std::string name;
  int colour = 0;
  std::vector<SweepPoint> points;  // by value
};

struct SweepPlot {
  std::string x_title, y_title;
  bool is_numeric = true;  // else values are places, in their order
  std::vector<double> marks;
  std::vector<SweepSeries> series;
};

// True if the values grow by factors rather than by amounts: then the axis is logarithmic.
[[nodiscard]] bool IsGeometric(std::vector<double> values);

[[nodiscard]] Drawing DrawSweep(const SweepPlot& plot, int width);

}  // namespace tcs::report
