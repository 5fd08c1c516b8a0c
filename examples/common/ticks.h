// A loop of a steady rate. Ticks are counted from the beginning on; those that have been missed are
// left out.
#pragma once

#include <time.h>

#include <cstdint>

namespace examples {

inline double Seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

class Ticks {
 public:
  explicit Ticks(double hz) : period_ns_(static_cast<std::int64_t>(1e9 / hz)), next_ns_(NowNs()) {}

  // Returns the seconds since the tick before.
  double WaitForNext() {
    const std::int64_t missed = (NowNs() - next_ns_) / period_ns_;
    const std::int64_t step_ns = (1 + (missed > 0 ? missed : 0)) * period_ns_;
    next_ns_ += step_ns;
    const timespec next{next_ns_ / 1'000'000'000, next_ns_ % 1'000'000'000};
    while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, nullptr) != 0) {
    }
    return 1e-9 * static_cast<double>(step_ns);
  }

 private:
  static std::int64_t NowNs() {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * 1'000'000'000 + now.tv_nsec;
  }

  const std::int64_t period_ns_;
  std::int64_t next_ns_;
};

}  // namespace examples
