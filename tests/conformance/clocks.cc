// Reading clocks: all of them move together, none goes back, and they say what they are.
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/times.h>

#include <atomic>
#include <thread>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

void Compute(std::int64_t cpu_ns) {
  const std::int64_t until = Now(CLOCK_PROCESS_CPUTIME_ID) + cpu_ns;
  volatile unsigned sink = 0;
  while (Now(CLOCK_PROCESS_CPUTIME_ID) < until) {
    for (int i = 0; i < 1000; ++i) sink = sink + 1;
  }
}

void NoClockGoesBack() {
  for (const clockid_t clock :
       {CLOCK_REALTIME, CLOCK_MONOTONIC, CLOCK_MONOTONIC_RAW, CLOCK_BOOTTIME, CLOCK_TAI,
        CLOCK_REALTIME_COARSE, CLOCK_MONOTONIC_COARSE, CLOCK_PROCESS_CPUTIME_ID,
        CLOCK_THREAD_CPUTIME_ID}) {
    std::int64_t last = Now(clock);
    for (int i = 0; i < 2000; ++i) {
      const std::int64_t now = Now(clock);
      EXPECT(now >= last, "clock %d went back by %lld ns", clock, (long long)(last - now));
      last = now;
    }
    timespec resolution{};
    EXPECT(clock_getres(clock, &resolution) == 0 && ToNs(resolution) > 0, "clock %d", clock);
  }
  timespec t;
  EXPECT(clock_gettime(9999, &t) == -1 && errno == EINVAL, "an unknown clock was read");
}

// While another thread wakes each 200 us, which is when a thread that computes is stopped a little
// too early, and has that time left: after work its clock shows more than before, and after a sleep
// more than when that was to end.
void NoWorkIsDoneInNoTime() {
  std::atomic<bool> stops{false};
  std::thread other([&stops] {
    while (!stops) {
      const timespec often = ToTimespec(200'000);
      nanosleep(&often, nullptr);
    }
  });
  volatile unsigned sink = 0;
  int still = 0;
  for (int i = 0; i < 20'000; ++i) {
    const std::int64_t before = Now();
    for (int k = 0; k < 1000; ++k) sink = sink + 1;
    if (Now() == before) ++still;
  }
  EXPECT(still == 0, "in %d of 20,000 pieces of work the clock stood still", still);
  int at_once = 0;
  for (int i = 0; i < 100; ++i) {
    const std::int64_t until = Now() + kMs;
    const timespec deadline = ToTimespec(until);
    EXPECT(clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, nullptr) == 0, "a sleep");
    if (Now() == until) ++at_once;
  }
  EXPECT(at_once == 0, "after %d of 100 sleeps no time had passed since their end", at_once);
  stops = true;
  other.join();
}

void WallClocksAgree() {
  const std::int64_t before = Now(CLOCK_REALTIME);
  timeval tv;
  gettimeofday(&tv, nullptr);
  timespec ts;
  EXPECT(timespec_get(&ts, TIME_UTC) == TIME_UTC, "timespec_get");
  const time_t seconds = time(nullptr);
  const std::int64_t after = Now(CLOCK_REALTIME);
  const std::int64_t of_day = tv.tv_sec * kSecond + tv.tv_usec * 1000;
  EXPECT(before / 1000 * 1000 <= of_day && of_day <= after, "gettimeofday: %lld",
         (long long)of_day);
  EXPECT(before <= ToNs(ts) && ToNs(ts) <= after, "timespec_get: %lld", (long long)ToNs(ts));
  // The kernel's time() may be a tick behind.
  EXPECT(before / kSecond - 1 <= seconds && seconds <= after / kSecond, "time: %lld",
         (long long)seconds);
}

void SleepingCostsNoProcessorTime() {
  const std::int64_t cpu = Now(CLOCK_PROCESS_CPUTIME_ID);
  const std::int64_t monotonic = Now(CLOCK_MONOTONIC), real = Now(CLOCK_REALTIME);
  usleep(200'000);
  ExpectSoonAfter(monotonic, 200 * kMs, "a sleep");
  const std::int64_t by_the_wall = Now(CLOCK_REALTIME) - real;
  EXPECT(by_the_wall >= 199 * kMs, "the wall clock: %lld ns", (long long)by_the_wall);
  if (g_mode != Mode::kNative) {
    EXPECT(by_the_wall < 205 * kMs, "the wall clock: %lld ns", (long long)by_the_wall);
  }
  EXPECT(Now(CLOCK_PROCESS_CPUTIME_ID) - cpu < 100 * kMs, "a sleep was charged");
}

// Natively others may have the processor, too, so that only one direction holds.
void ComputingTakesItsTime() {
  rusage usage_before{};
  getrusage(RUSAGE_SELF, &usage_before);
  tms ticks_before{};
  times(&ticks_before);
  const std::int64_t start = Now();
  const clock_t clock_before = clock();
  Compute(100 * kMs);
  const std::int64_t passed = Now() - start;
  EXPECT(passed >= 99 * kMs, "computing 100 ms took %lld ns", (long long)passed);
  if (g_mode != Mode::kNative) {
    EXPECT(passed < 105 * kMs, "computing 100 ms took %lld ns", (long long)passed);
  }
  const double by_clock = static_cast<double>(clock() - clock_before) / CLOCKS_PER_SEC;
  EXPECT(by_clock > 0.095 && by_clock < 0.15, "clock() says %f s", by_clock);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const double used =
      static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec -
                          usage_before.ru_utime.tv_sec - usage_before.ru_stime.tv_sec) +
      static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec -
                          usage_before.ru_utime.tv_usec - usage_before.ru_stime.tv_usec) *
          1e-6;
  EXPECT(used > 0.09 && used < 0.15, "getrusage says %f s", used);
  tms ticks{};
  times(&ticks);
  const long spent =
      (ticks.tms_utime + ticks.tms_stime) - (ticks_before.tms_utime + ticks_before.tms_stime);
  EXPECT(spent >= 8 && spent <= 15, "times says %ld ticks", spent);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  NoClockGoesBack();
  NoWorkIsDoneInNoTime();
  WallClocksAgree();
  SleepingCostsNoProcessorTime();
  ComputingTakesItsTime();
}
