// A planner whose work is as long as its seed says: from 0.1 s of its robot's time on it is
// released every 20 ms, reads a clock so many times, and waits for its next release. Under set
// costs that is what it computes.
//
//   seeded_planner SEED READS SPREAD  READS, times 1 - SPREAD … 1 + SPREAD percent
#include <stdlib.h>
#include <time.h>

#include <cstdint>

namespace {

constexpr std::int64_t kPeriodNs = 20'000'000;
constexpr std::int64_t kFirstReleaseNs = 1'000'100'000'000;  // robots start at 1000 s

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  auto state = static_cast<std::uint64_t>(atoll(argv[1])) * 7919 + 1;
  const double reads = atof(argv[2]), spread = atof(argv[3]) / 100;
  for (std::int64_t release = kFirstReleaseNs;; release += kPeriodNs) {
    timespec time{release / 1'000'000'000, release % 1'000'000'000};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr);
    state = state * 6364136223846793005 + 1442695040888963407;
    const double share = static_cast<double>(state >> 11) / static_cast<double>(1ULL << 53);
    for (auto i = static_cast<int>(reads * (1 + spread * (2 * share - 1))); i > 0; --i) {
      clock_gettime(CLOCK_MONOTONIC, &time);
    }
  }
}
