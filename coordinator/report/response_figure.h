// Response times against deadlines: for each client a histogram on an axis of its own, its deadline
// marked. Several systems' histograms of one client stand one above the other.
#pragma once

#include <string>
#include <vector>

#include "coordinator/report/figure.h"

namespace tcs::report {

struct ResponseRow {
  std::string system;  // empty: there is only one
  int colour = 0;
  double deadline_s = 0;  // 0: there is none
  std::vector<double> values_s;
};

struct ResponseGroup {
  std::string client;
  std::vector<ResponseRow> rows;  // at least one, each with values
};

[[nodiscard]] Drawing DrawResponses(const std::vector<ResponseGroup>& groups, int width);

}  // namespace tcs::report
