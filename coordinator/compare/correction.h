// Many figures compared at once: one in twenty would be found to differ by chance.
#pragma once

#include <vector>

namespace tcs::compare {

// Holm's correction: each probability so much greater that, of figures which do not differ at all,
// with a share of 1 - L of such comparisons none comes out below a limit L.
[[nodiscard]] std::vector<double> Corrected(const std::vector<double>& probabilities);

}  // namespace tcs::compare
