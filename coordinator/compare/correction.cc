#include "coordinator/compare/correction.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace tcs::compare {

std::vector<double> Corrected(const std::vector<double>& probabilities) {
  std::vector<std::size_t> order(probabilities.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return probabilities[i] < probabilities[j]; });
  std::vector<double> corrected(probabilities.size());
  double most = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto left = static_cast<double>(order.size() - i);
    most = std::max(most, std::min(1.0, left * probabilities[order[i]]));
    corrected[order[i]] = most;
  }
  return corrected;
}

}  // namespace tcs::compare
