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
  // Reads the links whose looks are due at `now`, the time that the dynamics have come to.
  void Read(const Sensors& sensors, VirtualTime now, Dynamics& dynamics);
  // The states that were read of `links`; all of `links` are due.
  void Give(std::span<const int> links, std::span<LinkState> states) const;

 private:
  std::vector<int> links_;  // in order, each once
  std::vector<LinkState> states_;
};

}  // namespace tcs
