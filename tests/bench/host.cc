#include "tests/bench/host.h"

#include <sched.h>
#include <time.h>
#include <x86gprintrin.h>

#include <cstdint>

namespace tcs::bench {

namespace {

constexpr std::int64_t kCalibrationNs = 50'000'000;

std::int64_t RawNowNs() {
  timespec now;
  clock_gettime(CLOCK_MONOTONIC_RAW, &now);
  return now.tv_sec * 1'000'000'000 + now.tv_nsec;
}

cpu_set_t before_binding;
bool is_bound = false;

}  // namespace

OnAllCpus::OnAllCpus() {
  if (is_bound) sched_setaffinity(0, sizeof before_binding, &before_binding);
}

OnAllCpus::~OnAllCpus() {
  if (is_bound) BindToLastCpu();
}

bool BindToLastCpu() {
  cpu_set_t allowed, one;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return false;
  before_binding = allowed;
  is_bound = true;
  int last = 0;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(cpu, &allowed)) last = cpu;
  }
  CPU_ZERO(&one);
  CPU_SET(last, &one);
  return sched_setaffinity(0, sizeof one, &one) == 0;
}

unsigned AllowedCpus() {
  cpu_set_t allowed;
  return sched_getaffinity(0, sizeof allowed, &allowed) == 0
             ? static_cast<unsigned>(CPU_COUNT(&allowed))
             : 1;
}

double NsPerTick() {
  const std::int64_t start_ns = RawNowNs();
  const std::uint64_t start_tsc = __rdtsc();
  std::int64_t passed_ns;
  do {
    passed_ns = RawNowNs() - start_ns;
  } while (passed_ns < kCalibrationNs);
  return static_cast<double>(passed_ns) / static_cast<double>(__rdtsc() - start_tsc);
}

}  // namespace tcs::bench
