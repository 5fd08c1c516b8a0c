// What several rounds of one measurement come to.
#pragma once

#include <algorithm>
#include <vector>

namespace tcs::bench {

struct Spread {
  double median = 0, lowest = 0, highest = 0;
};

// Of at least one value.
inline Spread SpreadOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {values[values.size() / 2], values.front(), values.back()};
}

}  // namespace tcs::bench
