// What several values of one measurement come to.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tcs::bench {

struct Spread {
  double median = 0, lowest = 0, highest = 0;
};

// Of at least one value.
inline Spread SpreadOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return {(values[(n - 1) / 2] + values[n / 2]) / 2, values.front(), values.back()};
}

}  // namespace tcs::bench
