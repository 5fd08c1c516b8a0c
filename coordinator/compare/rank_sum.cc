#include "coordinator/compare/rank_sum.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tcs::compare {

namespace {

constexpr std::size_t kMostExact = 60;

// Twice the ranks of all values, those of `a` first: with ties ranks are halves.
std::vector<int> DoubledRanks(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> all(a);
  all.insert(all.end(), b.begin(), b.end());
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&all](std::size_t i, std::size_t j) { return all[i] < all[j]; });
  std::vector<int> ranks(all.size());
  for (std::size_t from = 0; from < order.size();) {
    std::size_t to = from + 1;
    while (to < order.size() && all[order[to]] == all[order[from]]) ++to;
    // The mean of the ranks from + 1 … to, doubled.
    for (std::size_t i = from; i < to; ++i) ranks[order[i]] = static_cast<int>(from + 1 + to);
    from = to;
  }
  return ranks;
}

// Of all ways to choose `chosen` of the ranks, the share whose sum is at least as far from the
// middle.
double ExactShare(const std::vector<int>& ranks, std::size_t chosen, int sum) {
  const int total = std::accumulate(ranks.begin(), ranks.end(), 0);
  // ways[k][s]: to choose k ranks with the sum s. Counts go beyond integers, and need no more than
  // a double's digits.
  std::vector<std::vector<double>> ways(
      chosen + 1, std::vector<double>(static_cast<std::size_t>(total) + 1, 0.0));
  ways[0][0] = 1;
  std::size_t seen = 0;
  for (const int rank : ranks) {
    ++seen;
    for (std::size_t k = std::min(seen, chosen); k > 0; --k) {
      for (std::size_t s = static_cast<std::size_t>(total); s >= static_cast<std::size_t>(rank);
           --s) {
        ways[k][s] += ways[k - 1][s - static_cast<std::size_t>(rank)];
      }
    }
  }
  const double middle =
      static_cast<double>(total) * static_cast<double>(chosen) / static_cast<double>(ranks.size());
  const double far = std::abs(sum - middle);
  double as_far = 0, all = 0;
  for (std::size_t s = 0; s < ways[chosen].size(); ++s) {
    all += ways[chosen][s];
    if (std::abs(static_cast<double>(s) - middle) >= far - 1e-9) as_far += ways[chosen][s];
  }
  return as_far / all;
}

double NormalShare(const std::vector<int>& ranks, std::size_t chosen, int sum) {
  const auto all = static_cast<double>(ranks.size());
  const auto n = static_cast<double>(chosen), m = all - n;
  double mean = 0, squares = 0;
  for (const int rank : ranks) mean += rank / all;
  for (const int rank : ranks) squares += (rank - mean) * (rank - mean);
  // The variance of a sum of n ranks drawn without replacement.
  const double variance = n * m / (all * (all - 1)) * squares;
  if (variance <= 0) return 1;
  // The sums are whole numbers: half a step less far.
  const double far = std::max(0.0, std::abs(sum - n * mean) - 1);
  return std::erfc(far / std::sqrt(2 * variance));
}

}  // namespace

double RankSumProbability(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.empty() || b.empty()) return 1;
  const std::vector<int> ranks = DoubledRanks(a, b);
  const int sum =
      std::accumulate(ranks.begin(), ranks.begin() + static_cast<std::ptrdiff_t>(a.size()), 0);
  const bool is_exact = ranks.size() <= kMostExact;
  return std::min(1.0,
                  is_exact ? ExactShare(ranks, a.size(), sum) : NormalShare(ranks, a.size(), sum));
}

double LeastRankSumProbability(std::size_t a, std::size_t b) {
  if (a == 0 || b == 0) return 1;
  const auto log_factorial = [](std::size_t n) { return std::lgamma(static_cast<double>(n) + 1); };
  // Two of all the ways to choose: one sample all below the other, and all above it.
  const double log_ways = log_factorial(a + b) - log_factorial(a) - log_factorial(b);
  return std::min(1.0, 2 * std::exp(-log_ways));
}

}  // namespace tcs::compare
