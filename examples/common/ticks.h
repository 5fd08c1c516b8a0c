// A loop of a steady rate. Ticks are counted from the beginning on. One that is late is taken at
// once; of several that are, only the last.
#pragma once

#include <time.h>

#include <algorithm>
#include <cstdint>

namespace examples {

inline double Seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

class Ticks {
 public:
  explicit Ticks(double hz) : period_ns_(static_cast<std::int64_t>(1e9 / hz)), last_ns_(NowNs()) {}

  // Returns the seconds since the tick before.
  double WaitForNext() {
    const std::int64_t due = std::max<std::int64_t>(1, (NowNs() - last_ns_) / period_ns_);
    last_ns_ += due * period_ns_;
    const timespec next{last_ns_ / 1'000'000'000, last_ns_ % 1'000'000'000};
    while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, nullptr) != 0) {
    }
    return 1e-9 * static_cast<double>(due * period_ns_);
  }

 private:
  static std::int64_t NowNs() {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * 1'000'000'000 + now.tv_nsec;
  }

  const std::int64_t period_ns_;
  std::int64_t last_ns_;
};

}  // namespace examples
