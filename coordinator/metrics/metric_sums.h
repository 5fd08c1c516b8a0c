// The figures of a metric, kept while its values come. Pure; any number of values takes the same
// memory.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "coordinator/metrics/metric_figures.h"

namespace tcs {

// The square of a value has to be a number, too.
inline constexpr double kLargestMetricValue = 1e150;
inline bool IsMetricValue(double value) { return std::abs(value) <= kLargestMetricValue; }

class MetricSums {
 public:
  MetricSums() = default;
  explicit MetricSums(MetricFigures begin) : figures_(std::move(begin)) {}

  // IsMetricValue(value). `may_be_first`: first_time_ns may be of this value.
  void Add(std::int64_t time_ns, double value, bool may_be_first = true) {
    MetricFigures& f = figures_;
    ++f.count;
    f.last = value;
    f.min = f.count == 1 ? value : std::min(f.min, value);
    f.max = f.count == 1 ? value : std::max(f.max, value);
    // Running means, whose errors do not grow with the number of values.
    const auto n = static_cast<double>(f.count);
    f.mean += (value - f.mean) / n;
    mean_square_ += (value * value - mean_square_) / n;
    f.rms = std::sqrt(mean_square_);
    if (may_be_first && f.first_time_ns < 0) f.first_time_ns = time_ns;
  }

  [[nodiscard]] const MetricFigures& figures() const { return figures_; }

 private:
  MetricFigures figures_;
  double mean_square_ = 0;
};

}  // namespace tcs
