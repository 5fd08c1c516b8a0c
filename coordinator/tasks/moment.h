// When something happens to a thread, and whose doing it is. Whoever wakes somebody says it.
#pragma once

#include <cstdint>

namespace tcs {

struct Moment {
  std::int64_t ns = 0;        // virtual time of the robots
  bool from_outside = false;  // time or the world brings it about, not another thread
};

}  // namespace tcs
