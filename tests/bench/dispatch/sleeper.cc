// sleeper PERIOD_US PHASE_US: wakes once a period, and does nothing then. It knows nothing of tcs.
#include <time.h>

#include <cstdlib>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const long period_ns = 1'000 * std::atol(argv[1]);
  timespec next;
  clock_gettime(CLOCK_MONOTONIC, &next);
  next.tv_nsec += 1'000 * std::atol(argv[2]);
  for (;;) {
    next.tv_nsec += period_ns;
    while (next.tv_nsec >= 1'000'000'000) {
      next.tv_nsec -= 1'000'000'000;
      ++next.tv_sec;
    }
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, nullptr);
  }
}
