// How long programs may compute while their clocks stand, before tcsim does something about it.
#pragma once

#include <algorithm>

#include "coordinator/scenario/scenario.h"
#include "shm/virtual_time.h"

namespace tcs {

struct Patience {
  HostDuration silent = HostDuration::Seconds(5);       // without a call, under set costs
  HostDuration ideal = HostDuration::Seconds(10);       // on an ideal robot
  VirtualDuration held = VirtualDuration::Seconds(10);  // under callback, of the program's own time
};

// A patience that the scenario says holds for all three.
inline Patience PatienceOf(const Scenario& scenario) {
  if (!scenario.patience) return {.held = std::max(Patience{}.held, scenario.duration)};
  return {*scenario.patience, *scenario.patience,
          VirtualDuration::Nanoseconds(scenario.patience->ns())};
}

}  // namespace tcs
