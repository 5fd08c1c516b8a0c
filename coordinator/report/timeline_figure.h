// The picture of timelines that needs no script: the whole of each run. page/timeline.js draws the
// same for any part of a run.
#pragma once

#include <vector>

#include "coordinator/report/figure.h"
#include "coordinator/report/timeline.h"

namespace tcs::report {

// Draws the share of each column's time that each row ran, over virtual time, with a mark where a
// deadline was missed.
[[nodiscard]] Drawing DrawTimelines(const std::vector<Timeline>& timelines, int width);

}  // namespace tcs::report
