#include "coordinator/doctor/wakeups.h"

#include <sched.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <thread>
#include <vector>

#include "shm/time_values.h"

namespace tcs {

namespace {

constexpr int kSleeps = 1000, kPriority = 80;
constexpr std::int64_t kSleepNs = 1'000'000;

std::int64_t NowNs() {
  timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return shm::ToNs(now);
}

// In the order of their lengths.
std::vector<std::int64_t> Latenesses() {
  std::vector<std::int64_t> late;
  for (int i = 0; i < kSleeps; ++i) {
    // Each at another part of the timer's tick.
    const std::int64_t until_ns = NowNs() + kSleepNs + i * 7919 % 1000;
    const timespec until = shm::ToTimespec(until_ns);
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
    }
    late.push_back(NowNs() - until_ns);
  }
  std::sort(late.begin(), late.end());
  return late;
}

}  // namespace

std::optional<Wakeups> MeasureWakeups(int policy) {
  std::vector<std::int64_t> late;
  // The caller's policy stays as it is.
  std::thread([&] {
    const sched_param priority{policy == SCHED_OTHER ? 0 : kPriority};
    // A filter may refuse the call even where nothing changes.
    if (sched_getscheduler(0) == policy || sched_setscheduler(0, policy, &priority) == 0)
      late = Latenesses();
  }).join();
  if (late.empty()) return std::nullopt;
  return Wakeups{late[late.size() / 2], late[late.size() * 99 / 100]};
}

}  // namespace tcs
