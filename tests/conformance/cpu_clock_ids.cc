// The clocks of what a process and a thread have computed, by their ids.
#include <pthread.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

int main(int argc, char** argv) {
  Begin(argc, argv);
  clockid_t process = 0, thread = 0;
  EXPECT(clock_getcpuclockid(0, &process) == 0, "clock_getcpuclockid");
  EXPECT(pthread_getcpuclockid(pthread_self(), &thread) == 0, "pthread_getcpuclockid");
  clockid_t named = 0;
  EXPECT(clock_getcpuclockid(getpid(), &named) == 0, "clock_getcpuclockid");
  for (const clockid_t clock : {process, named, thread}) {
    const std::int64_t start_time = Now(), start = Now(clock);
    usleep(300'000);
    EXPECT(Now(clock) - start < 100 * kMs, "a sleep was charged");
    // Under tcs the clock's readings are what moves it with set costs.
    while (Now(clock) - start < 20 * kMs) {
    }
    // A thread's clock may have been ahead of what it had computed, and it makes up for that.
    const std::int64_t ahead = g_mode == Mode::kMeasured ? kMs / 5 : 0;
    const std::int64_t passed = Now() - start_time;
    EXPECT(passed >= 320 * kMs - ahead, "computing 20 ms and a sleep took %lld ns",
           (long long)passed);
  }
  EXPECT(Now(thread) <= Now(process), "a thread has computed more than its process");
}
