// When something happens to a thread, and whose doing it is. A caller that wakes a thread says it.
#pragma once

#include "shm/time_kinds.h"

namespace tcs {

struct EventTime {
  VirtualTime at;             // of the robots
  bool from_outside = false;  // time or the world brings it about, not another thread
};

}  // namespace tcs
