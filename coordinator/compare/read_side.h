// Reading of what is compared: the folder of a run, or that of trials.
#pragma once

#include <string>

#include "coordinator/compare/side.h"
#include "coordinator/errors/load_error.h"

namespace tcs::compare {

// Reads a side; of a run also how its response and execution times and its misses varied within the
// run, from activations.csv. The error is one sentence: the folder is neither that of a run nor of
// trials, or holds nothing that went to its end.
[[nodiscard]] LoadResult<Side> ReadSide(const std::string& folder);

// Cuts the values into `parts` rows of neighbours, and returns the median of each row; none if
// there are too few values for five in each row.
[[nodiscard]] std::vector<double> PartMedians(const std::vector<double>& values, std::size_t parts);

}  // namespace tcs::compare
