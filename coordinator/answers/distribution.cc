#include "coordinator/answers/distribution.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace tcs {

namespace {

constexpr int kBits = 11;  // of a rounded value, which is off by less than 1 / 2^10
constexpr std::size_t kMostNew = 1024;

}  // namespace

void Distribution::Add(std::int64_t value_ns) {
  new_values_.push_back(std::max<std::int64_t>(0, value_ns));
  if (new_values_.size() == kMostNew) Settle();
}

void Distribution::Add(const Distribution& other) {
  Settle();
  other.Settle();
  if (other.count_ == 0) return;
  min_ = count_ == 0 ? other.min_ : std::min(min_, other.min_);
  max_ = std::max(max_, other.max_);
  count_ += other.count_;
  sum_ += other.sum_;
  for (const auto& [value, count] : other.counts_)
    counts_[is_rounded_ ? Rounded(value) : value] += count;
  RoundIfMany();
}

std::int64_t Distribution::count() const {
  return count_ + static_cast<std::int64_t>(new_values_.size());
}

std::int64_t Distribution::max() const {
  Settle();
  return max_;
}

std::int64_t Distribution::min() const {
  Settle();
  return min_;
}

double Distribution::Mean() const {
  Settle();
  return count_ == 0 ? 0 : sum_ / static_cast<double>(count_);
}

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

// In order, so that each value has its place beside the value before.
void Distribution::Settle() const {
  if (new_values_.empty()) return;
  std::ranges::sort(new_values_);
  min_ = count_ == 0 ? new_values_.front() : std::min(min_, new_values_.front());
  max_ = std::max(max_, new_values_.back());
  count_ += static_cast<std::int64_t>(new_values_.size());
  for (const std::int64_t value : new_values_) {
    sum_ += static_cast<double>(value);
    ++counts_[is_rounded_ ? Rounded(value) : value];
  }
  new_values_.clear();
  RoundIfMany();
}

void Distribution::RoundIfMany() const {
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
