// Reading of what is compared: the folder of a run, or that of trials.
#pragma once

#include <string>

#include "coordinator/compare/side.h"
#include "coordinator/errors/load_error.h"

namespace tcs::compare {

// Of a run also how its response and execution times and its misses varied in itself, from
// activations.csv. One sentence if the folder is neither, or holds nothing that went to its end.
[[nodiscard]] LoadResult<Side> ReadSide(const std::string& folder);

// Cuts the values into `parts` rows of neighbours, and returns the median of each; none if there
// are too few for five in each.
[[nodiscard]] std::vector<double> PartMedians(const std::vector<double>& values, std::size_t parts);

}  // namespace tcs::compare
