// The pictures of a replay that need no script: where the robots went, from above and from the
// side, and their positions over time. page/robots.js draws the same, and more.
#pragma once

#include "coordinator/report/figure.h"
#include "coordinator/report/replay.h"

namespace tcs::report {

// The replay has moments.
[[nodiscard]] Drawing DrawPaths(const Replay& replay, int width);
// The motion of the first few robots that move.
[[nodiscard]] Drawing DrawMotion(const Replay& replay, int width);

}  // namespace tcs::report
