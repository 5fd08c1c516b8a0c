#include "tests/bench/probe/calls.h"

#include <pthread.h>
#include <sched.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

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

double MutexTicks() {
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  return TicksPerCall({1000, 1000}, [&] {
    pthread_mutex_lock(&mutex);
    pthread_mutex_unlock(&mutex);
  });
}

double KernelCallTicks() {
  return TicksPerCall({1000, 1000}, [] { syscall(SYS_getppid); });
}

}  // namespace tcs::bench
