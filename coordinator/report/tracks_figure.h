// Distance over time: a panel per system, a thin line per trial, their median in bold.
#pragma once

#include <vector>

#include "coordinator/report/figure.h"
#include "coordinator/report/results.h"

namespace tcs::report {

// The median over the trials at each of the times at which all of the first trial's samples lie.
[[nodiscard]] Track MedianTrack(const System& system);

struct TracksPanel {
  const System* system;
  int colour;
};

[[nodiscard]] Drawing DrawTracks(const std::vector<TracksPanel>& panels,
                                 const std::vector<double>& marks, int width);

}  // namespace tcs::report
