// How long a robot's kernel takes from an event to the moment at which the thread that has waited
// for it is ready to run: its interrupts, timers and scheduler. Log-normal, as such times are found
// to be, given by its median and its 99th percentile, and never more than ten times that.
//
// Pure: from one seed a thread's n-th wake-up always takes the same time, whatever others do.
#pragma once

#include <cstdint>

#include "shm/time_kinds.h"

namespace tcs {

class WakeupLatency {
 public:
  static constexpr std::int64_t kMostTimesP99 = 10;

  // No time at all.
  WakeupLatency() = default;
  // `median` is more than 0, and `p99` is not below it.
  WakeupLatency(VirtualDuration median, VirtualDuration p99, std::uint64_t seed);

  bool IsNone() const { return median_ == VirtualDuration(); }
  VirtualDuration Of(int thread, std::int64_t wakeup) const;

 private:
  VirtualDuration median_, most_;
  double spread_ = 0;  // the standard deviation of the logarithm
  std::uint64_t seed_ = 0;
};

}  // namespace tcs
