// How values are spread: a histogram per panel, one above the other, on one axis.
#pragma once

#include <string>
#include <vector>

#include "coordinator/report/figure.h"
#include "coordinator/report/plot.h"

namespace tcs::report {

struct HistogramPanel {
  std::string name;
  int colour = 0;
  std::vector<double> values;
};

struct HistogramPlot {
  std::string x_title;  // with its unit
  std::string unit;
  std::string what;  // what one value is
  std::vector<double> marks;
  std::vector<HistogramPanel> panels;  // at least one has values
};

// Draws the shares of the values in percent, in bins of `bin_width` of the axis, which lies in the
// frame; draws the axis beside the frame, too.
void DrawHistogram(Svg* svg, const Frame& frame, const Axis& x, const std::vector<double>& values,
                   double bin_width, int colour);

[[nodiscard]] Drawing DrawHistograms(const HistogramPlot& plot, int width);

}  // namespace tcs::report
