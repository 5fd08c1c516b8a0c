// The rank-sum test of Mann and Whitney: how often chance alone would order two samples as unlike
// as they are. The test asks nothing of the distributions, and is not misled by a few extreme
// values.
#pragma once

#include <cstddef>
#include <vector>

namespace tcs::compare {

// The probability (0 … 1), two-sided, that samples as unlike as these come from one distribution.
// Ties are taken into account. Exact up to 60 values in all, beyond that by the normal
// approximation. 1 where a sample is empty.
[[nodiscard]] double RankSumProbability(const std::vector<double>& a, const std::vector<double>& b);

// The least probability that the test can find with so many values: that of samples of which one
// lies all above the other.
[[nodiscard]] double LeastRankSumProbability(std::size_t a, std::size_t b);

}  // namespace tcs::compare
