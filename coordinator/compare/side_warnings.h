// How two sides differ that should be alike, in sentences.
#pragma once

#include <string>
#include <vector>

#include "coordinator/compare/side.h"

namespace tcs::compare {

// Those of the sides themselves among them; `only_a` and `only_b` are figures that only one has.
[[nodiscard]] std::vector<std::string> WarningsOf(const Side& a, const Side& b,
                                                  const std::vector<std::string>& only_a,
                                                  const std::vector<std::string>& only_b);

}  // namespace tcs::compare
