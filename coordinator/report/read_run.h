// Reading of one run's folder.
#pragma once

#include <string>
#include <vector>

#include "coordinator/errors/load_error.h"
#include "coordinator/report/results.h"

namespace tcs::report {

// Which runs are wanted: those that went to their end and of which no client failed, or any; of one
// that was cut off what it noted last is taken as its summary, if it noted anything, and a warning
// says so.
enum class Ends { kWhole, kAny };

// That of two bodies is read, or not, where nobody asks for it.
enum class Distance { kRead, kLeftOut };

// The distance is that between `bodies`, or, if those are empty, between the first body that
// bodies.csv names and the first one of another model. Lines that are of no use are left out with a
// warning. The sentence of an error names the folder.
[[nodiscard]] LoadResult<Run> ReadRun(const std::string& folder,
                                      const std::vector<std::string>& bodies, Ends ends,
                                      std::vector<std::string>* warnings,
                                      Distance distance = Distance::kRead);

// What its summary says, without its tables: for many runs.
[[nodiscard]] LoadResult<Run> ReadRunFigures(const std::string& folder,
                                             std::vector<std::string>* warnings);

// That, and the times of its activations.
[[nodiscard]] LoadResult<Run> ReadRunTimes(const std::string& folder,
                                           std::vector<std::string>* warnings);

}  // namespace tcs::report
