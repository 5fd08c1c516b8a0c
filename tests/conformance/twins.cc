// The other names under which the C library's functions go, in its own headers, in older programs
// and in other libraries: they do the same.
#include <dlfcn.h>
#include <signal.h>
#include <sys/select.h>
#include <sys/time.h>
#include <sys/timeb.h>
#include <threads.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

// Null where this C library has no such name.
template <class F>
F* Named(const char* name) {
  return reinterpret_cast<F*>(dlsym(RTLD_DEFAULT, name));
}

void Sleeps() {
  const timespec wanted = ToTimespec(20 * kMs);
  std::int64_t start = Now();
  EXPECT(thrd_sleep(&wanted, nullptr) == 0, "thrd_sleep");
  ExpectWaited(start, 20 * kMs, 2, "thrd_sleep");
  if (auto* twin = Named<decltype(nanosleep)>("__nanosleep"); twin != nullptr) {
    start = Now();
    EXPECT(twin(&wanted, nullptr) == 0, "__nanosleep");
    ExpectWaited(start, 20 * kMs, 2, "__nanosleep");
  }
  if (auto* twin = Named<decltype(clock_nanosleep)>("__clock_nanosleep"); twin != nullptr) {
    start = Now();
    EXPECT(twin(CLOCK_MONOTONIC, 0, &wanted, nullptr) == 0, "__clock_nanosleep");
    ExpectWaited(start, 20 * kMs, 2, "__clock_nanosleep");
  }
  if (auto* twin = Named<decltype(select)>("__select"); twin != nullptr) {
    start = Now();
    timeval timeout{0, 20'000};
    EXPECT(twin(0, nullptr, nullptr, nullptr, &timeout) == 0, "__select");
    ExpectWaited(start, 20 * kMs, 2, "__select");
  }
}

volatile sig_atomic_t g_alarms = 0;

void Alarms() {
  struct sigaction action {};
  action.sa_handler = [](int) { g_alarms = g_alarms + 1; };
  sigaction(SIGALRM, &action, nullptr);
  EXPECT(ualarm(900'000, 0) == 0, "no alarm was set");
  const useconds_t left = ualarm(30'000, 0);
  EXPECT(left > 800'000 && left <= 900'000, "ualarm says %u us were left", left);
  const std::int64_t start = Now();
  EXPECT(usleep(500'000) == -1 && errno == EINTR && g_alarms == 1, "an alarm did not come");
  const std::int64_t passed = Now() - start;
  EXPECT(passed >= 29 * kMs && passed < 400 * kMs, "ualarm after %lld ns", (long long)passed);
}

void Clocks() {
  if (auto* twin = Named<decltype(clock_gettime)>("__clock_gettime"); twin != nullptr) {
    const std::int64_t before = Now();
    timespec now;
    EXPECT(twin(CLOCK_MONOTONIC, &now) == 0, "__clock_gettime");
    EXPECT(before <= ToNs(now) && ToNs(now) <= Now(), "__clock_gettime: %lld",
           (long long)ToNs(now));
  }
  if (auto* twin = Named<decltype(clock_getres)>("__clock_getres"); twin != nullptr) {
    timespec resolution;
    EXPECT(twin(CLOCK_MONOTONIC, &resolution) == 0 && ToNs(resolution) > 0, "__clock_getres");
  }
  const std::int64_t before = Now(CLOCK_REALTIME);
  if (auto* twin = Named<int(timeval*, void*)>("__gettimeofday"); twin != nullptr) {
    timeval now;
    EXPECT(twin(&now, nullptr) == 0, "__gettimeofday");
    const std::int64_t ns = now.tv_sec * kSecond + now.tv_usec * 1000;
    EXPECT(before / 1000 * 1000 <= ns && ns <= Now(CLOCK_REALTIME), "__gettimeofday: %lld",
           (long long)ns);
  }
  if (auto* old = Named<int(struct timeb*)>("ftime"); old != nullptr) {
    struct timeb now {};
    EXPECT(old(&now) == 0, "ftime");
    const std::int64_t ns = now.time * kSecond + now.millitm * kMs;
    EXPECT(before - 20 * kMs <= ns && ns <= Now(CLOCK_REALTIME), "ftime: %lld", (long long)ns);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  Sleeps();
  Clocks();
  Alarms();
}
