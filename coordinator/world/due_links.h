// The links that sensors look at in an instant, read all at once: robots that are apart are
// integrated side by side then, and a link with several sensors is read once.
#pragma once

#include <span>
#include <vector>

#include "coordinator/world/sensors.h"
#include "simbody_bridge/dynamics.h"

namespace tcs {

class DueLinks {
 public:
  // Those whose looks are due at `now`, which the dynamics have come to.
  void Read(const Sensors& sensors, VirtualTime now, Dynamics& dynamics);
  // What was read of these; all of them are due.
  void Give(std::span<const int> links, std::span<LinkState> states) const;

 private:
  std::vector<int> links_;  // in order, each once
  std::vector<LinkState> states_;
};

}  // namespace tcs
