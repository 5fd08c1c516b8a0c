// A few numbers that tell of many. All functions take any number of values, none included.
#pragma once

#include <cstdint>
#include <vector>

namespace tcs::report {

struct Spread {
  std::int64_t count = 0;
  double mean = 0;
  double deviation = 0;  // standard deviation of a sample (n - 1); 0 for fewer than two values
  double least = 0, lower_quartile = 0, median = 0, upper_quartile = 0, most = 0;
};

// All fields are 0 for no values. Values that are not finite must not be among them.
[[nodiscard]] Spread SpreadOf(std::vector<double> values);

// The quantile is between the two nearest values where no value is exactly there (R's type 7).
// `sorted` is not empty; `share` is 0 … 1.
[[nodiscard]] double Quantile(const std::vector<double>& sorted, double share);

// The share of `values` that lies below `limit`; 0 for no values.
[[nodiscard]] double ShareBelow(const std::vector<double>& values, double limit);

struct Histogram {
  double low = 0, width = 1;  // of the first bin; of each
  std::vector<std::int64_t> counts;
  std::int64_t total = 0;

  [[nodiscard]] double ShareOf(std::size_t bin) const;
};

// Bins of `width` from `low` to at least `high`, lower edges included; a value outside counts in
// the first or the last bin.
[[nodiscard]] Histogram HistogramOf(const std::vector<double>& values, double low, double high,
                                    double width);

}  // namespace tcs::report
