// How two sides differ that should be alike, in sentences.
#pragma once

#include <string>
#include <vector>

#include "coordinator/compare/side.h"

namespace tcs::compare {

// The warnings, those of the sides themselves among them. `only_b` are figures that only b has,
// `rarer` figures that a smaller share of b's trials has.
[[nodiscard]] std::vector<std::string> WarningsOf(const Side& a, const Side& b,
                                                  const std::vector<std::string>& only_b,
                                                  const std::vector<std::string>& rarer);

}  // namespace tcs::compare
