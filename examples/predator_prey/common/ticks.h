// The ticks of a steady period: instants at which something is to be done, as a deadline for
// whoever waits. They are counted from the beginning on, so they do not drift however late each is
// noticed.
#pragma once

#include <chrono>
#include <cstdint>

namespace predator_prey {

class Ticks {
 public:
  using Clock = std::chrono::steady_clock;

  // The first tick is due one period from now.
  explicit Ticks(Clock::duration period) : period_(period), next_(Clock::now() + period) {}

  // When the next tick is due.
  Clock::time_point next() const { return next_; }

  // Takes the ticks that have become due since the last call: 0 if none has, more than 1 if the
  // caller is late.
  std::uint64_t Take() {
    const Clock::time_point now = Clock::now();
    if (now < next_) return 0;
    const auto ticks = (now - next_) / period_ + 1;
    next_ += ticks * period_;
    return static_cast<std::uint64_t>(ticks);
  }

 private:
  Clock::duration period_;
  Clock::time_point next_;
};

}  // namespace predator_prey
