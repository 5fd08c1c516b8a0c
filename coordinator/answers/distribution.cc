#include "coordinator/answers/distribution.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace tcs {

namespace {

constexpr int kBits = 11;  // that a rounded value keeps: it is off by less than 1 / 2^10
constexpr std::size_t kMostNew = 1024;

}  // namespace

void Distribution::Add(std::int64_t value_ns) {
  value_ns = std::max<std::int64_t>(0, value_ns);
  max_ = std::max(max_, value_ns);
  min_ = count_ == 0 ? value_ns : std::min(min_, value_ns);
  ++count_;
  sum_ += static_cast<double>(value_ns);
  new_values_.push_back(value_ns);
  if (new_values_.size() == kMostNew) Settle();
}

double Distribution::Mean() const { return count_ == 0 ? 0 : sum_ / static_cast<double>(count_); }

std::int64_t Distribution::Quantile(double share) const {
  Settle();
  const auto rank =
      std::clamp<std::int64_t>(std::llround(std::ceil(share * static_cast<double>(count_))), 1,
                               std::max<std::int64_t>(1, count_));
  if (rank == count_) return max_;
  std::int64_t seen = 0;
  for (const auto& [value, count] : counts_) {
    seen += count;
    if (seen >= rank) return value;
  }
  return 0;
}

// In order, so that each has its place beside the one before.
void Distribution::Settle() const {
  std::ranges::sort(new_values_);
  for (const std::int64_t value : new_values_) ++counts_[is_rounded_ ? Rounded(value) : value];
  new_values_.clear();
  if (is_rounded_ || counts_.size() <= kMostValues) return;
  is_rounded_ = true;
  for (const auto& [value, count] : std::exchange(counts_, {})) counts_[Rounded(value)] += count;
}

std::int64_t Distribution::Rounded(std::int64_t value_ns) {
  const int width = std::bit_width(static_cast<std::uint64_t>(value_ns));
  if (width <= kBits) return value_ns;
  const int dropped = width - kBits;
  return value_ns >> dropped << dropped;
}

}  // namespace tcs
