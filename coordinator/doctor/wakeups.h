// How long the kernel of this machine takes to wake a thread: what `cpu.wakeup` is for a robot
// whose computer is like this machine.
#pragma once

#include <cstdint>
#include <optional>

namespace tcs {

struct Wakeups {
  std::int64_t median_ns = 0, p99_ns = 0;
};

// Of a thread's sleeps of a millisecond each, a second in all, natively. `policy`: SCHED_OTHER, or
// a real-time one, at the priority that cyclictest is usually given; none where it is not
// permitted.
std::optional<Wakeups> MeasureWakeups(int policy);

}  // namespace tcs
