// CLOCK_MONOTONIC in seconds.
#pragma once

#include <chrono>

namespace predator_prey {

inline double MonotonicSeconds() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

}  // namespace predator_prey
