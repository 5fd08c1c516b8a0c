#include "tests/bench/probe/calls.h"

#include <sched.h>
#include <time.h>

#include "tests/bench/probe/batches.h"

namespace tcs::bench {

double ClockReadTicks() {
  timespec now;
  return TicksPerCall({1000, 1000}, [&] { clock_gettime(CLOCK_MONOTONIC, &now); });
}

double ShortSleepTicks() {
  const timespec microsecond{0, 1000};
  return TicksPerCall({500, 1000}, [&] { nanosleep(&microsecond, nullptr); });
}

double ExchangeTicks() {
  return TicksPerCall({100, 50}, [] { sched_yield(); });
}

}  // namespace tcs::bench
