// A periodic task: released every PERIOD_US from 0.1 s of its robot's time on, it computes for
// RUNTIME_US and waits for its next release. Prints how long after its release each job was done.
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include <cstdint>
#include <vector>

namespace {

constexpr std::int64_t kFirstReleaseNs = 1'000'100'000'000;  // robots start at 1000 s

std::int64_t Now(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return t.tv_sec * 1'000'000'000 + t.tv_nsec;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const std::int64_t runtime_ns = atoll(argv[1]) * 1000, period_ns = atoll(argv[2]) * 1000;
  std::vector<std::int64_t> responses(static_cast<std::size_t>(atoi(argv[3])));
  std::int64_t release = kFirstReleaseNs;
  for (std::int64_t& response : responses) {
    const timespec t{release / 1'000'000'000, release % 1'000'000'000};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr);
    const std::int64_t end = Now(CLOCK_THREAD_CPUTIME_ID) + runtime_ns;
    while (Now(CLOCK_THREAD_CPUTIME_ID) < end) {
    }
    response = Now(CLOCK_MONOTONIC) - release;
    release += period_ns;
  }
  for (const std::int64_t response : responses) printf("%lld\n", (long long)response);
}
