#pragma once

#include <cstdint>

#include "shm/virtual_time.h"

namespace tcs {

// A step's length in whole nanoseconds, as islands count: the next step then begins where this one
// ends, and its first derivatives are known.
inline double WholeNanoseconds(double seconds) {
  const auto ns = static_cast<std::int64_t>(seconds * 1e9);
  return ns > 0 ? VirtualDuration::Nanoseconds(ns).seconds() : seconds;
}

}  // namespace tcs
