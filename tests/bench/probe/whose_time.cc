#include "tests/bench/probe/whose_time.h"

#include <time.h>
#include <unistd.h>
#include <x86gprintrin.h>

#include <cstdint>
#include <cstdlib>

namespace tcs::bench {

namespace {

constexpr unsigned kHour = 3600;
// Real seconds, but few, on any processor.
constexpr std::uint64_t kAtOnceTicks = 20'000'000'000;
// tcs_bench tells libfaketime to start in 2000.
constexpr time_t kYear2001 = 978'307'200;

time_t MonotonicSeconds() {
  timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec;
}

bool SleepsAnHourAtOnce() {
  const time_t start = MonotonicSeconds();
  const std::uint64_t start_tsc = __rdtsc();
  sleep(kHour);
  return MonotonicSeconds() - start >= kHour && __rdtsc() - start_tsc < kAtOnceTicks;
}

}  // namespace

std::string NotIn(const std::string& world) {
  // Asked first: where nobody would shorten it, the hour must not be slept.
  const bool coordinated = getenv("TCS_SOCKET") != nullptr;
  const bool faked = time(nullptr) < kYear2001;
  if (world == "tcs") {
    if (!coordinated) return "there is no coordinator";
    return SleepsAnHourAtOnce() ? "" : "an hour's sleep took real time";
  }
  if (coordinated) return "there is a coordinator";
  if (world == "faketime") return faked ? "" : "the date is the host's";
  return faked ? "the date is before 2001" : "";
}

}  // namespace tcs::bench
