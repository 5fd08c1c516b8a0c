// How a figure was distributed over a run, in a bounded space: count, sum and extremes to the
// nanosecond, quantiles, too, as long as the values are few enough; beyond that quantiles are
// rounded down by less than 0.1 %.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace tcs {

class Distribution {
 public:
  // Of so many different values quantiles are exact.
  static constexpr std::size_t kMostValues = 16'384;

  // A value of less than nothing counts as 0.
  void Add(std::int64_t value_ns);
  // Adds all values of the other distribution.
  void Add(const Distribution& other);

  std::int64_t count() const;
  std::int64_t max() const;  // 0 without a value, as all that follows
  std::int64_t min() const;
  double Mean() const;
  // The least value that at least that share of all values do not exceed (nearest rank).
  std::int64_t Quantile(double share) const;

 private:
  static std::int64_t Rounded(std::int64_t value_ns);
  void Settle() const;
  void RoundIfMany() const;

  // New values are only noted: a run has many distributions, and none of them is at hand.
  mutable std::vector<std::int64_t> new_values_;
  // Of the values before these:
  mutable std::map<std::int64_t, std::int64_t> counts_;  // by value
  mutable std::int64_t count_ = 0, max_ = 0, min_ = 0;
  mutable double sum_ = 0;
  mutable bool is_rounded_ = false;
};

}  // namespace tcs
