// What clients wrote, and when.
#pragma once

#include <string>

#include "coordinator/report/replay.h"

namespace tcs::report {

// Appends the lines of a run's folder (output.csv and the clients' logs) to `replay`, in their
// order in time. Where there are more than a page should hold, of each client its earliest are
// kept.
void ReadSaid(const std::string& folder, Replay* replay);

}  // namespace tcs::report
