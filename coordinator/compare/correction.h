// Corrects for many figures compared at once: of those, one in twenty would be found to differ by
// chance.
#pragma once

#include <vector>

namespace tcs::compare {

// Holm's correction: makes each probability so much greater that, of figures which do not differ at
// all, in a share of 1 - L of such comparisons no figure comes out below a limit L.
[[nodiscard]] std::vector<double> Corrected(const std::vector<double>& probabilities);

}  // namespace tcs::compare
