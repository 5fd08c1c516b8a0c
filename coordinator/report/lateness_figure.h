// How late activations begin: per client and system the median, the 99th percentile and the most.
#pragma once

#include <string>
#include <vector>

#include "coordinator/report/figure.h"

namespace tcs::report {

struct LatenessRow {
  std::string name;
  int colour = 0;
  double median_s = 0, high_s = 0, most_s = 0;  // high: the 99th percentile
};

struct LatenessGroup {
  std::string name;  // the client's
  std::vector<LatenessRow> rows;
};

[[nodiscard]] Drawing DrawLateness(const std::vector<LatenessGroup>& groups, int width);

}  // namespace tcs::report
