// Sleeping: never short, and to the nanosecond where costs are set.
#include "tests/conformance/conformance.h"

using namespace conformance;

int main(int argc, char** argv) {
  Begin(argc, argv);
  std::int64_t start = Now();
  const timespec relative = ToTimespec(123'456'789);
  EXPECT(nanosleep(&relative, nullptr) == 0, "nanosleep");
  ExpectWaited(start, 123'456'789, 2, "nanosleep");

  start = Now();
  EXPECT(usleep(70'001) == 0, "usleep");
  ExpectWaited(start, 70'001'000, 2, "usleep");

  start = Now();
  EXPECT(sleep(1) == 0, "sleep");
  ExpectWaited(start, kSecond, 2, "sleep");

  for (const clockid_t clock : {CLOCK_MONOTONIC, CLOCK_REALTIME}) {
    start = Now();
    EXPECT(clock_nanosleep(clock, 0, &relative, nullptr) == 0, "clock_nanosleep");
    ExpectWaited(start, 123'456'789, 2, "clock_nanosleep");

    start = Now();
    const timespec deadline = ToTimespec(Now(clock) + 50 * kMs);
    EXPECT(clock_nanosleep(clock, TIMER_ABSTIME, &deadline, nullptr) == 0, "absolute");
    // The deadline was made of a reading one call later than `start`, and its own call comes before
    // it.
    ExpectWaited(start, 50 * kMs, 2, "an absolute clock_nanosleep");

    start = Now();
    const timespec past = ToTimespec(Now(clock) - 50 * kMs);
    EXPECT(clock_nanosleep(clock, TIMER_ABSTIME, &past, nullptr) == 0, "past");
    ExpectWaited(start, 0, 3, "a deadline in the past");
  }

  timespec bad{0, 1'000'000'000};
  EXPECT(nanosleep(&bad, nullptr) == -1 && errno == EINVAL, "a whole second of nanoseconds");
  bad = {-1, 0};
  EXPECT(nanosleep(&bad, nullptr) == -1 && errno == EINVAL, "a negative time");
  EXPECT(clock_nanosleep(CLOCK_MONOTONIC, 0, &bad, nullptr) == EINVAL, "a negative time");
  EXPECT(clock_nanosleep(9999, 0, &relative, nullptr) == EINVAL, "an unknown clock");

  start = Now();
  for (int i = 0; i < 1000; ++i) usleep(1000);
  if (g_mode == Mode::kMeasured) {  // what a thousand calls cost is the host's
    ExpectSoonAfter(start, kSecond, "a thousand sleeps of 1 ms", 100 * kMs);
  } else {
    ExpectWaited(start, kSecond, 1001, "a thousand sleeps of 1 ms");
  }
}
