// Reading of one run's folder.
#pragma once

#include <string>
#include <vector>

#include "coordinator/errors/load_error.h"
#include "coordinator/report/results.h"

namespace tcs::report {

// Which runs are wanted: runs that went to their end and of which no client failed, or any. For a
// run that was cut off the last note is taken as its summary, if the run noted anything, and a
// warning says so.
enum class Ends { kWhole, kAny };

// Whether the distance of two bodies is read where nobody asks for it.
enum class Distance { kRead, kLeftOut };

// The distance is that between `bodies`, or, if those are empty, between the first body that
// bodies.csv names and the first one of another model. Lines that are of no use are left out with a
// warning. The sentence of an error names the folder.
[[nodiscard]] LoadResult<Run> ReadRun(const std::string& folder,
                                      const std::vector<std::string>& bodies, Ends ends,
                                      std::vector<std::string>* warnings,
                                      Distance distance = Distance::kRead);

// Reads a run's summary, without its tables: for many runs.
[[nodiscard]] LoadResult<Run> ReadRunFigures(const std::string& folder,
                                             std::vector<std::string>* warnings);

// Reads a run's summary, and the times of its activations.
[[nodiscard]] LoadResult<Run> ReadRunTimes(const std::string& folder,
                                           std::vector<std::string>* warnings);

}  // namespace tcs::report
