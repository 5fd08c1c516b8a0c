// Tells when a thread that was dispatched does not get the processor, because threads that the
// coordinator does not know have it. The thread's CPU clock tells, and costs a system call: so it
// is asked seldom, and half as often once it has told. Pure.
#pragma once

#include <cstdint>
#include <utility>

namespace tcs {

class StarvationWatch {
 public:
  static constexpr std::int64_t kFirstNs = 20'000'000;

  // The thread runs from `tsc` on.
  StarvationWatch(std::uint64_t tsc, double ticks_per_ns)
      : looked_tsc_(tsc), ticks_(kFirstNs * ticks_per_ns) {}

  // Whether it is time to ask the thread's CPU clock.
  bool IsDue(std::uint64_t tsc) const { return static_cast<double>(tsc - looked_tsc_) > ticks_; }

  // The CPU clock was asked (-1: it cannot be read). True if the clock has stood still since it was
  // asked before.
  bool Starves(std::uint64_t tsc, std::int64_t cpu_ns) {
    looked_tsc_ = tsc;
    if (cpu_ns < 0 || std::exchange(cpu_ns_, cpu_ns) != cpu_ns) return false;
    ticks_ *= 2;
    return true;
  }

 private:
  std::uint64_t looked_tsc_;
  double ticks_;
  std::int64_t cpu_ns_ = -1;
};

}  // namespace tcs
