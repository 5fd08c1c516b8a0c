#include "coordinator/port/clocks.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>
#include <x86gprintrin.h>

#include <algorithm>
#include <cstdlib>

#include "shm/clock_ids.h"
#include "shm/time_values.h"

namespace tcs {

std::uint64_t HostTsc() { return __rdtsc(); }

std::int64_t HostClockNs(clockid_t id) {
  timespec t;
  clock_gettime(id, &t);
  return shm::ToNs(t);
}

namespace {

// An instant by both clocks.
struct TscReading {
  std::uint64_t tsc;
  std::int64_t raw_ns;
};

// The tightest of some readings: where the host was away between the two clocks, their values are
// of no one instant.
TscReading ReadTsc() {
  TscReading best{};
  std::uint64_t least_ticks = UINT64_MAX;
  for (int i = 0; i < 8; ++i) {
    const std::uint64_t before_tsc = __rdtsc();
    const std::int64_t raw_ns = HostClockNs(CLOCK_MONOTONIC_RAW);
    const std::uint64_t ticks = __rdtsc() - before_tsc;
    if (ticks >= least_ticks) continue;
    least_ticks = ticks;
    best = {before_tsc + ticks / 2, raw_ns};
  }
  return best;
}

constexpr std::int64_t kCalibrationNs = 10'000'000;

// When the process was loaded: a run has much to prepare before it asks for the rate.
const TscReading tsc_at_load = ReadTsc();

}  // namespace

std::uint64_t CalibrateTsc() {
  const std::int64_t left_ns =
      tsc_at_load.raw_ns + kCalibrationNs - HostClockNs(CLOCK_MONOTONIC_RAW);
  timespec left = shm::ToTimespec(std::max<std::int64_t>(left_ns, 0));
  while (nanosleep(&left, &left) != 0 && errno == EINTR) continue;
  const TscReading now = ReadTsc();
  return static_cast<std::uint64_t>(static_cast<double>(now.raw_ns - tsc_at_load.raw_ns) /
                                    static_cast<double>(now.tsc - tsc_at_load.tsc) * 4294967296.0);
}

std::int64_t ProcessCpuClockNs(pid_t pid) {
  timespec t;
  return clock_gettime(shm::CpuClockOf(pid), &t) == 0 ? shm::ToNs(t) : -1;
}

// A thread's own clock can be read by its own process only; schedstat has the same number.
int OpenThreadCpuClock(pid_t tid) {
  char path[64];
  snprintf(path, sizeof path, "/proc/%d/schedstat", tid);
  return open(path, O_RDONLY | O_CLOEXEC);
}

std::int64_t ReadThreadCpuClock(int fd) {
  char text[128];
  const ssize_t n = pread(fd, text, sizeof text - 1, 0);
  if (n <= 0) return -1;
  text[n] = '\0';
  return strtoll(text, nullptr, 10);
}

}  // namespace tcs
