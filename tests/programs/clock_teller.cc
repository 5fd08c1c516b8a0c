// Reads each clock before and after a sleep of an hour, as a program does that is linked statically
// too, and says how many seconds each says it took, and on which processor it is.
#include <sched.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include <cstdio>

int main() {
  timeval day, day_after;
  timespec before, after;
  // From soon after a second has begun: else time() may pass into its next one on the way.
  gettimeofday(&day, nullptr);
  usleep(static_cast<useconds_t>(1'010'000 - day.tv_usec));
  const time_t date = time(nullptr);
  gettimeofday(&day, nullptr);
  clock_gettime(CLOCK_MONOTONIC, &before);
  sleep(3600);
  clock_gettime(CLOCK_MONOTONIC, &after);
  gettimeofday(&day_after, nullptr);
  const time_t later = time(nullptr);
  // Whole seconds that have passed.
  printf("%ld %ld %ld on %d\n", static_cast<long>(later - date),
         static_cast<long>(day_after.tv_sec - day.tv_sec - (day_after.tv_usec < day.tv_usec)),
         static_cast<long>(after.tv_sec - before.tv_sec - (after.tv_nsec < before.tv_nsec)),
         sched_getcpu());
}
