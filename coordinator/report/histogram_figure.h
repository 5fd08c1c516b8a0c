// How values are spread: a histogram per panel, one above the other, on one axis.
#pragma once

#include <string>
#include <vector>

#include "coordinator/report/figure.h"

namespace tcs::report {

struct HistogramPanel {
  std::string name;
  int colour = 0;
  std::vector<double> values;
};

struct HistogramPlot {
  std::string x_title;  // with its unit
  std::string unit;
  std::string what;  // one value is
  std::vector<double> marks;
  std::vector<HistogramPanel> panels;  // at least one has values
};

[[nodiscard]] Drawing DrawHistograms(const HistogramPlot& plot, int width);

}  // namespace tcs::report
