// The date can be set, for the run alone; nothing disciplines its clock.
#include <dlfcn.h>
#include <semaphore.h>
#include <signal.h>
#include <sys/time.h>
#include <sys/timerfd.h>
#include <sys/timex.h>

#include <functional>
#include <thread>
#include <utility>
#include <vector>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

bool MaySet() {
  timex step{};
  step.modes = ADJ_SETOFFSET | ADJ_NANO;
  return adjtimex(&step) >= 0 || errno != EPERM;
}

// Natively these would set the host's clock, or be refused, whoever runs the test.
void Refused() {
  const timeval delta{0, 1000};
  EXPECT(adjtime(&delta, nullptr) == -1 && errno == EPERM, "adjtime");
  timeval left{7, 7};
  EXPECT(adjtime(nullptr, &left) == 0 && left.tv_sec == 0 && left.tv_usec == 0, "adjtime reads");
  timex change{};
  change.modes = ADJ_FREQUENCY;
  EXPECT(adjtimex(&change) == -1 && errno == EPERM, "adjtimex");
  EXPECT(ntp_adjtime(&change) == -1 && errno == EPERM, "ntp_adjtime");
  EXPECT(clock_adjtime(CLOCK_REALTIME, &change) == -1 && errno == EPERM, "clock_adjtime");
  change.modes = ADJ_NANO;
  EXPECT(adjtimex(&change) == -1 && errno == EPERM, "adjtimex of a unit");
  const timespec before_start = ToTimespec(kSecond);
  EXPECT(clock_settime(CLOCK_REALTIME, &before_start) == -1 && errno == (MaySet() ? EINVAL : EPERM),
         "a date before the computer was started: %s", strerror(errno));
  EXPECT(clock_settime(CLOCK_MONOTONIC, &before_start) == -1 && errno == EINVAL, "another clock");
  struct timezone zone {};
  EXPECT(settimeofday(nullptr, nullptr) == 0, "settimeofday of nothing");
  EXPECT(settimeofday(nullptr, &zone) == -1 && errno == EPERM, "a time zone");
}

constexpr std::int64_t kHour = 3600 * kSecond;

int SetTo(std::int64_t date_ns) {
  const timespec date = ToTimespec(date_ns);
  return clock_settime(CLOCK_REALTIME, &date);
}

// Each way to set the date; CLOCK_MONOTONIC does not change.
void Set() {
  const auto steps = [](const char* what, std::int64_t by_ns, const auto& set) {
    const std::int64_t date = Now(CLOCK_REALTIME), time = Now();
    EXPECT(set(date + by_ns) == 0, "%s: %s", what, strerror(errno));
    const std::int64_t passed = Now() - time, shown = Now(CLOCK_REALTIME) - date - by_ns;
    EXPECT(passed >= 0 && passed < 5 * kMs, "%s: the time changed by %lld ns", what,
           (long long)passed);
    EXPECT(shown >= -kSecond && shown < 5 * kMs + passed, "%s: %lld ns", what, (long long)shown);
  };
  steps("clock_settime", kHour, SetTo);
  steps("settimeofday", -kHour, [](std::int64_t date_ns) {
    const timeval date{date_ns / kSecond, date_ns % kSecond / 1000};
    return settimeofday(&date, nullptr);
  });
  auto* stime = reinterpret_cast<int (*)(const time_t*)>(dlsym(RTLD_DEFAULT, "stime"));
  steps("stime", kHour, [stime](std::int64_t date_ns) {
    const time_t date = date_ns / kSecond;
    return stime(&date);
  });
  steps("raw clock_settime", -kHour, [](std::int64_t date_ns) {
    const timespec date = ToTimespec(date_ns);
    return syscall(SYS_clock_settime, CLOCK_REALTIME, &date);
  });
  steps("raw settimeofday", kHour, [](std::int64_t date_ns) {
    const timeval date{date_ns / kSecond, date_ns % kSecond / 1000};
    return syscall(SYS_settimeofday, &date, nullptr);
  });
  timex raw{};
  const std::int64_t before = Now(CLOCK_REALTIME);
  EXPECT(syscall(SYS_adjtimex, &raw) >= 0, "raw adjtimex: %s", strerror(errno));
  const std::int64_t read_ns = raw.time.tv_sec * kSecond + kSecond;
  EXPECT(read_ns > before && read_ns - before <= kSecond + 5 * kMs, "raw adjtimex: another date");
  raw.modes = ADJ_TICK;
  EXPECT(syscall(SYS_adjtimex, &raw) == -1 && errno == EPERM, "raw adjtimex");
  EXPECT(syscall(SYS_clock_adjtime, CLOCK_REALTIME, &raw) == -1 && errno == EPERM, "clock_adjtime");
  steps("adjtimex", -kHour / 2, [](std::int64_t) {
    timex step{};
    step.modes = ADJ_SETOFFSET | ADJ_NANO;
    step.time.tv_sec = -kHour / 2 / kSecond;
    return adjtimex(&step) >= 0 ? 0 : -1;
  });
}

// While a thread is in `wait`, which is to end 100 ms later, at a date or not, another one sets the
// date an hour on or back after 20 ms. Returns how long the wait took.
template <class Wait>
std::int64_t Took(std::int64_t by_ns, Wait wait) {
  const std::int64_t start = Now();
  std::thread setter([=] {
    usleep(20'000);
    EXPECT(SetTo(Now(CLOCK_REALTIME) + by_ns) == 0, "clock_settime: %s", strerror(errno));
  });
  wait();
  const std::int64_t took = Now() - start;
  setter.join();
  EXPECT(SetTo(Now(CLOCK_REALTIME) - by_ns) == 0, "clock_settime: %s", strerror(errno));
  return took;
}

void WaitForTimer(clockid_t clock, int flags, std::int64_t value_ns) {
  const int fd = timerfd_create(clock, 0);
  const itimerspec value{{}, ToTimespec(value_ns)};
  EXPECT(timerfd_settime(fd, flags, &value, nullptr) == 0, "timerfd_settime");
  std::uint64_t count = 0;
  EXPECT(read(fd, &count, sizeof count) == sizeof count && count == 1, "%d", int(count));
  close(fd);
}

void WaitForPosixTimer(int flags, std::int64_t value_ns) {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGUSR1);
  sigevent event{};
  event.sigev_signo = SIGUSR1;
  timer_t timer;
  EXPECT(timer_create(CLOCK_REALTIME, &event, &timer) == 0, "timer_create");
  const itimerspec value{{}, ToTimespec(value_ns)};
  EXPECT(timer_settime(timer, flags, &value, nullptr) == 0, "timer_settime");
  EXPECT(sigwaitinfo(&set, nullptr) == SIGUSR1, "sigwaitinfo");
  timer_delete(timer);
}

// Waits to a date move with it; the others do not.
void Waits() {
  const auto date_in_100_ms = [] { return Now(CLOCK_REALTIME) + 100 * kMs; };
  const auto sleep_until = [](clockid_t clock, std::int64_t ns, bool raw) {
    const timespec until = ToTimespec(ns);
    if (raw) {
      EXPECT(syscall(SYS_clock_nanosleep, clock, TIMER_ABSTIME, &until, nullptr) == 0, "raw sleep");
    } else {
      EXPECT(clock_nanosleep(clock, TIMER_ABSTIME, &until, nullptr) == 0, "clock_nanosleep");
    }
  };
  const std::vector<std::pair<const char*, std::function<void()>>> by_date = {
      {"clock_nanosleep", [&] { sleep_until(CLOCK_REALTIME, date_in_100_ms(), false); }},
      {"raw clock_nanosleep", [&] { sleep_until(CLOCK_REALTIME, date_in_100_ms(), true); }},
      {"sem_timedwait",
       [&] {
         sem_t semaphore;
         sem_init(&semaphore, 0, 0);
         const timespec until = ToTimespec(date_in_100_ms());
         EXPECT(sem_timedwait(&semaphore, &until) == -1 && errno == ETIMEDOUT, "sem_timedwait");
       }},
      {"pthread_mutex_timedlock",
       [&] {
         pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
         pthread_mutex_lock(&mutex);
         const timespec until = ToTimespec(date_in_100_ms());
         EXPECT(pthread_mutex_timedlock(&mutex, &until) == ETIMEDOUT, "timedlock");
       }},
      {"timerfd", [&] { WaitForTimer(CLOCK_REALTIME, TFD_TIMER_ABSTIME, date_in_100_ms()); }},
      {"timer_create", [&] { WaitForPosixTimer(TIMER_ABSTIME, date_in_100_ms()); }},
  };
  const std::vector<std::pair<const char*, std::function<void()>>> by_time = {
      {"usleep", [] { usleep(100'000); }},
      {"clock_nanosleep by CLOCK_MONOTONIC",
       [&] { sleep_until(CLOCK_MONOTONIC, Now() + 100 * kMs, false); }},
      {"timerfd from now", [] { WaitForTimer(CLOCK_REALTIME, 0, 100 * kMs); }},
      {"timerfd by CLOCK_MONOTONIC",
       [] { WaitForTimer(CLOCK_MONOTONIC, TFD_TIMER_ABSTIME, Now() + 100 * kMs); }},
      {"timer_create from now", [] { WaitForPosixTimer(0, 100 * kMs); }},
  };
  const auto is = [](std::int64_t took, std::int64_t wanted) {
    return took >= wanted && took < wanted + (g_mode == Mode::kFixed ? 3 : 15) * kMs;
  };
  for (const auto& [what, wait] : by_date) {
    const std::int64_t on = Took(kHour, wait), back = Took(-kHour, wait);
    EXPECT(is(on, 20 * kMs), "%s, the date an hour on: %lld ns", what, (long long)on);
    EXPECT(is(back, kHour + 100 * kMs), "%s, back: %lld ns", what, (long long)back);
  }
  for (const auto& [what, wait] : by_time) {
    for (const std::int64_t by : {kHour, -kHour}) {
      const std::int64_t took = Took(by, wait);
      EXPECT(is(took, 100 * kMs), "%s, the date set by %lld: %lld ns", what, (long long)by,
             (long long)took);
    }
  }
}

template <class State>
void ExpectNow(const State& state, bool in_ns, std::int64_t before, const char* what) {
  const std::int64_t fraction = state.time.tv_usec * (in_ns ? 1 : 1000);
  const std::int64_t ns = state.time.tv_sec * kSecond + fraction;
  EXPECT(before / 1000 * 1000 <= ns && ns <= Now(CLOCK_REALTIME), "%s: %lld", what, (long long)ns);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  if (g_mode != Mode::kNative) {
    Refused();
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGUSR1);
    pthread_sigmask(SIG_BLOCK, &set, nullptr);
    if (MaySet()) {
      Set();
      Waits();
    } else {
      EXPECT(SetTo(Now(CLOCK_REALTIME) + kHour) == -1 && errno == EPERM, "clock_settime");
    }
  }
  timex state{};
  std::int64_t before = Now(CLOCK_REALTIME);
  EXPECT(adjtimex(&state) >= 0, "adjtimex: %s", strerror(errno));
  ExpectNow(state, (state.status & STA_NANO) != 0, before, "adjtimex");
  before = Now(CLOCK_REALTIME);
  EXPECT(clock_adjtime(CLOCK_REALTIME, &state) >= 0, "clock_adjtime: %s", strerror(errno));
  ExpectNow(state, (state.status & STA_NANO) != 0, before, "clock_adjtime");
  const bool in_ns = (state.status & STA_NANO) != 0;
  ntptimeval time{};
  before = Now(CLOCK_REALTIME);
  EXPECT(ntp_gettimex(&time) >= 0, "ntp_gettimex: %s", strerror(errno));
  ExpectNow(time, in_ns, before, "ntp_gettimex");
  EXPECT(ntp_gettime(&time) >= 0, "ntp_gettime: %s", strerror(errno));
  ExpectNow(time, in_ns, before, "ntp_gettime");
  auto* old = reinterpret_cast<int (*)(ntptimeval*)>(dlsym(RTLD_DEFAULT, "ntp_gettime"));
  EXPECT(old != nullptr && old(&time) >= 0, "ntp_gettime");
  ExpectNow(time, in_ns, before, "ntp_gettime, the function of this name");
  timex again{};
  auto* twin = reinterpret_cast<int (*)(timex*)>(dlsym(RTLD_DEFAULT, "__adjtimex"));
  EXPECT(twin != nullptr && twin(&again) >= 0, "__adjtimex");
  ExpectNow(again, in_ns, before, "__adjtimex");
  timespec resolution{};
  EXPECT(timespec_getres(&resolution, TIME_UTC) == TIME_UTC && ToNs(resolution) > 0, "getres");
  EXPECT(timespec_getres(&resolution, 99) == 0, "an unknown base");
  if (g_mode != Mode::kNative) EXPECT(state.freq == 0 && state.offset == 0, "a disciplined clock");
}
