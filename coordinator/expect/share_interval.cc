#include "coordinator/expect/share_interval.h"

#include <cmath>

namespace tcs {

namespace {

constexpr double kTail = 0.025;  // of 95 %, on either side
constexpr int kHalvings = 60;

// The probability that `most` or fewer of `trials` hold, where each trial does with probability p.
double AtMost(std::int64_t most, std::int64_t trials, double p) {
  if (most >= trials || p <= 0) return 1;
  if (p >= 1) return 0;
  const auto n = static_cast<double>(trials);
  const double log_odds = std::log(p) - std::log1p(-p);
  double log_term = n * std::log1p(-p), sum = 0;
  for (std::int64_t i = 0; i <= most; ++i) {
    sum += std::exp(log_term);
    const auto k = static_cast<double>(i);
    log_term += std::log((n - k) / (k + 1)) + log_odds;
  }
  return sum;
}

// The p at which AtMost falls to `probability`; AtMost falls as p grows.
double WhereAtMostIs(double probability, std::int64_t most, std::int64_t trials) {
  double low = 0, high = 1;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2;
    (AtMost(most, trials, middle) > probability ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

ShareInterval ClopperPearson(std::int64_t held, std::int64_t trials) {
  ShareInterval interval;
  if (held > 0) interval.low = WhereAtMostIs(1 - kTail, held - 1, trials);
  if (held < trials) interval.high = WhereAtMostIs(kTail, held, trials);
  return interval;
}

}  // namespace tcs
