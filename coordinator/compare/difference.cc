#include "coordinator/compare/difference.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>

#include "coordinator/report/statistics.h"

namespace tcs::compare {

namespace {

constexpr std::size_t kMostOfSample = 1000;
constexpr int kResamples = 2000;
constexpr double kNormal = 1.959964;  // 2.5 % of a normal distribution lie beyond

std::vector<double> Thinned(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  if (values.size() <= kMostOfSample) return values;
  std::vector<double> kept(kMostOfSample);
  for (std::size_t i = 0; i < kMostOfSample; ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(kMostOfSample);
    kept[i] = report::Quantile(values, share);
  }
  return kept;
}

double MeanOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// The mean of as many values as `values` has, drawn from these with replacement. The standard's
// distributions differ between libraries; the numbers of the engine do not.
double DrawnMean(const std::vector<double>& values, std::mt19937_64& engine) {
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) sum += values[engine() % values.size()];
  return sum / static_cast<double>(values.size());
}

}  // namespace

Difference ShiftBetween(const std::vector<double>& a, const std::vector<double>& b) {
  const std::vector<double> first = Thinned(a), second = Thinned(b);
  std::vector<double> differences;
  differences.reserve(first.size() * second.size());
  for (const double x : first) {
    for (const double y : second) differences.push_back(y - x);
  }
  std::sort(differences.begin(), differences.end());
  const auto n = static_cast<double>(first.size()), m = static_cast<double>(second.size());
  // The number of differences that are outside the interval at each end.
  const double outside = std::floor(n * m / 2 - kNormal * std::sqrt(n * m * (n + m + 1) / 12));
  const auto place = static_cast<std::size_t>(std::max(0.0, outside));
  return {report::Quantile(differences, 0.5), differences[place],
          differences[differences.size() - 1 - place]};
}

Difference MeanDifference(const std::vector<double>& a, const std::vector<double>& b) {
  std::mt19937_64 engine(1);
  std::vector<double> drawn(kResamples);
  for (double& difference : drawn) difference = DrawnMean(b, engine) - DrawnMean(a, engine);
  std::sort(drawn.begin(), drawn.end());
  return {MeanOf(b) - MeanOf(a), report::Quantile(drawn, 0.025), report::Quantile(drawn, 0.975)};
}

}  // namespace tcs::compare
