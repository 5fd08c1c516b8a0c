#include "coordinator/report/statistics.h"

#include <algorithm>
#include <cmath>

namespace tcs::report {

double Quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

Spread SpreadOf(std::vector<double> values) {
  Spread spread;
  if (values.empty()) return spread;
  std::sort(values.begin(), values.end());
  spread.count = static_cast<std::int64_t>(values.size());
  const auto n = static_cast<double>(values.size());
  double sum = 0;
  for (const double value : values) sum += value;
  spread.mean = sum / n;
  double squares = 0;
  for (const double value : values) squares += (value - spread.mean) * (value - spread.mean);
  spread.deviation = values.size() < 2 ? 0.0 : std::sqrt(squares / (n - 1));
  spread.least = values.front();
  spread.lower_quartile = Quantile(values, 0.25);
  spread.median = Quantile(values, 0.5);
  spread.upper_quartile = Quantile(values, 0.75);
  spread.most = values.back();
  return spread;
}

double ShareBelow(const std::vector<double>& values, double limit) {
  if (values.empty()) return 0.0;
  const auto below =
      std::count_if(values.begin(), values.end(), [limit](double value) { return value < limit; });
  return static_cast<double>(below) / static_cast<double>(values.size());
}

double Histogram::ShareOf(std::size_t bin) const {
  return total == 0 ? 0.0 : static_cast<double>(counts[bin]) / static_cast<double>(total);
}

Histogram HistogramOf(const std::vector<double>& values, double low, double high, double width) {
  Histogram histogram;
  histogram.low = low;
  histogram.width = width;
  // A high end that only rounding puts beyond the last edge needs no bin of its own.
  const double bins = std::ceil((high - low) / width - 1e-9);
  histogram.counts.resize(static_cast<std::size_t>(std::clamp(bins, 1.0, 1e6)));
  const auto last = static_cast<double>(histogram.counts.size() - 1);
  for (const double value : values) {
    const double bin = std::clamp(std::floor((value - low) / width), 0.0, last);
    ++histogram.counts[static_cast<std::size_t>(bin)];
    ++histogram.total;
  }
  return histogram;
}

}  // namespace tcs::report
