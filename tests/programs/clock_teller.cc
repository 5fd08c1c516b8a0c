// Reads each clock before and after a sleep of an hour, as a program does that is linked statically
// too, and says how many seconds each says it took, and on which processor it is.
#include <sched.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include <cstdio>

int main() {
  const time_t date = time(nullptr);
  timeval day, day_after;
  timespec before, after;
  gettimeofday(&day, nullptr);
  clock_gettime(CLOCK_MONOTONIC, &before);
  sleep(3600);
  clock_gettime(CLOCK_MONOTONIC, &after);
  gettimeofday(&day_after, nullptr);
  printf("%ld %ld %ld on %d\n", static_cast<long>(time(nullptr) - date),
         static_cast<long>(day_after.tv_sec - day.tv_sec),
         static_cast<long>(after.tv_sec - before.tv_sec), sched_getcpu());
}
