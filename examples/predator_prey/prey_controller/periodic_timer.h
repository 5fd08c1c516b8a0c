// A timer that ticks every period of CLOCK_MONOTONIC. Owns its descriptor, which is readable when a
// tick is due. For one thread.
#pragma once

#include <cstdint>

#include "examples/predator_prey/prey_controller/unique_fd.h"

namespace predator_prey {

class PeriodicTimer {
 public:
  // The first tick is due one period from now. Throws std::system_error.
  explicit PeriodicTimer(double period_s);

  int fd() const { return fd_.get(); }

  // Takes the ticks that have become due since the last call: 0 if none has, more than 1 if the
  // caller is late.
  std::uint64_t TakeTicks();

 private:
  UniqueFd fd_;
};

}  // namespace predator_prey
