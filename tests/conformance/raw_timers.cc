// Timers whose calls are made raw: virtual like all others, and the same as those made by symbol.
#include <poll.h>
#include <signal.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/timerfd.h>

#include "tests/conformance/conformance.h"

namespace {

using namespace conformance;

bool IsNear(std::int64_t ns, std::int64_t wanted) {
  return ns <= wanted && (g_mode == Mode::kNative || ns > wanted - 5 * kMs);
}

itimerspec Every(std::int64_t first, std::int64_t interval = 0) {
  return {ToTimespec(interval), ToTimespec(first)};
}

volatile sig_atomic_t g_handled = 0, g_value = 0;

void Handle(int, siginfo_t* info, void*) {
  g_handled = g_handled + 1;
  g_value = info->si_value.sival_int;
}

// Until the handler has run so often.
void AwaitHandled(int times) {
  while (g_handled < times) usleep(1'000'000);
}

void PosixTimers() {
  sigevent event{};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = SIGUSR1;
  event.sigev_value.sival_int = 42;
  int id = -1, other = -1;
  EXPECT(syscall(SYS_timer_create, CLOCK_MONOTONIC, &event, &id) == 0, "%s", strerror(errno));
  EXPECT(syscall(SYS_timer_create, CLOCK_REALTIME, &event, &other) == 0 && id != other, "%s",
         strerror(errno));
  std::int64_t start = Now();
  itimerspec value = Every(50 * kMs, 20 * kMs), old{};
  g_handled = 0;
  EXPECT(syscall(SYS_timer_settime, id, 0, &value, nullptr) == 0, "%s", strerror(errno));
  for (int turn = 1; turn <= 3; ++turn) {
    AwaitHandled(turn);
    ExpectPassed(start, (30 + turn * 20) * kMs, "timer_create");
    EXPECT(g_value == 42, "value %d", (int)g_value);
  }
  EXPECT(syscall(SYS_timer_gettime, id, &old) == 0 && ToNs(old.it_interval) == 20 * kMs &&
             IsNear(ToNs(old.it_value), 20 * kMs),
         "gettime: %lld", (long long)ToNs(old.it_value));
  value = Every(0);
  EXPECT(syscall(SYS_timer_settime, id, 0, &value, &old) == 0 && ToNs(old.it_interval) == 20 * kMs,
         "settime");
  EXPECT(syscall(SYS_timer_gettime, id, &old) == 0 && ToNs(old.it_value) == 0, "disarmed");
  const long overruns = syscall(SYS_timer_getoverrun, id);
  EXPECT(overruns == 0 || (g_mode == Mode::kNative && overruns > 0), "%ld, %s", overruns,
         strerror(errno));

  // Absolute, on CLOCK_REALTIME.
  start = Now();
  g_handled = 0;
  value = Every(Now(CLOCK_REALTIME) + 70 * kMs);
  EXPECT(syscall(SYS_timer_settime, other, TIMER_ABSTIME, &value, nullptr) == 0, "settime");
  AwaitHandled(1);
  ExpectPassed(start, 70 * kMs, "an absolute time");
  EXPECT(syscall(SYS_timer_delete, id) == 0 && syscall(SYS_timer_delete, other) == 0, "delete");
  EXPECT(syscall(SYS_timer_settime, id, 0, &value, nullptr) == -1 && errno == EINVAL, "is there");
  EXPECT(syscall(SYS_timer_create, 77, &event, &id) == -1 && errno == EINVAL, "no such clock");
  event.sigev_signo = 99;
  EXPECT(syscall(SYS_timer_create, CLOCK_MONOTONIC, &event, &id) == -1 && errno == EINVAL,
         "no such signal");

  // Without an event: SIGALRM. To one thread, and to nobody.
  EXPECT(syscall(SYS_timer_create, CLOCK_MONOTONIC, nullptr, &id) == 0, "%s", strerror(errno));
  event.sigev_notify = SIGEV_THREAD_ID;
  event.sigev_signo = SIGUSR1;
  event._sigev_un._tid = static_cast<int>(syscall(SYS_gettid));
  EXPECT(syscall(SYS_timer_create, CLOCK_MONOTONIC, &event, &other) == 0, "%s", strerror(errno));
  for (const int timer : {id, other}) {
    start = Now();
    g_handled = 0;
    value = Every(30 * kMs);
    EXPECT(syscall(SYS_timer_settime, timer, 0, &value, nullptr) == 0, "settime");
    AwaitHandled(1);
    ExpectPassed(start, 30 * kMs, "SIGALRM or a thread's");
    EXPECT(syscall(SYS_timer_delete, timer) == 0, "delete");
  }
}

std::uint64_t ReadTimer(int fd) {
  std::uint64_t count = 0;
  EXPECT(read(fd, &count, sizeof count) == sizeof count, "read: %s", strerror(errno));
  return count;
}

enum class Made { kRaw, kBySymbol };

// Made one way, set and asked the other way, and both.
void Descriptors(Made made, Made set) {
  const bool raw = set == Made::kRaw;
  const auto create = [made](clockid_t clock, int flags) {
    return made == Made::kRaw ? static_cast<int>(syscall(SYS_timerfd_create, clock, flags))
                              : timerfd_create(clock, flags);
  };
  const auto settime = [raw](int fd, int flags, itimerspec value, itimerspec* old) {
    return raw ? static_cast<int>(syscall(SYS_timerfd_settime, fd, flags, &value, old))
               : timerfd_settime(fd, flags, &value, old);
  };
  const auto gettime = [raw](int fd, itimerspec* value) {
    return raw ? static_cast<int>(syscall(SYS_timerfd_gettime, fd, value))
               : timerfd_gettime(fd, value);
  };
  const int fd = create(CLOCK_MONOTONIC, TFD_CLOEXEC);
  EXPECT(fd >= 0, "timerfd_create: %s", strerror(errno));
  std::int64_t start = Now();
  EXPECT(settime(fd, 0, Every(50 * kMs, 25 * kMs), nullptr) == 0, "%s", strerror(errno));
  // Natively a busy machine may be late by a period.
  const bool is_native = g_mode == Mode::kNative;
  EXPECT(ReadTimer(fd) == 1 || is_native, "count");
  ExpectPassed(start, 50 * kMs, "the first expiry");
  pollfd waited{fd, POLLIN, 0};
  EXPECT(poll(&waited, 1, 1000) == 1, "poll");
  ExpectPassed(start, 75 * kMs, "the second expiry");
  EXPECT(ReadTimer(fd) == 1 || is_native, "count");
  itimerspec left{};
  EXPECT(gettime(fd, &left) == 0 && ToNs(left.it_interval) == 25 * kMs &&
             IsNear(ToNs(left.it_value), 25 * kMs),
         "gettime: %lld", (long long)ToNs(left.it_value));
  usleep(60'000);
  if (!is_native) EXPECT(ReadTimer(fd) == 2, "two more");
  EXPECT(settime(fd, 0, Every(0), &left) == 0 && ToNs(left.it_interval) == 25 * kMs, "settime");
  EXPECT(gettime(fd, &left) == 0 && ToNs(left.it_value) == 0, "disarmed");
  close(fd);

  const int real = create(CLOCK_REALTIME, TFD_NONBLOCK);
  EXPECT(real >= 0, "timerfd_create: %s", strerror(errno));
  start = Now();
  const std::int64_t until = Now(CLOCK_REALTIME) + 40 * kMs;
  EXPECT(settime(real, TFD_TIMER_ABSTIME, Every(until), nullptr) == 0, "%s", strerror(errno));
  std::uint64_t count;
  EXPECT(read(real, &count, sizeof count) == -1 && errno == EAGAIN, "%s", strerror(errno));
  waited.fd = real;
  EXPECT(poll(&waited, 1, 1000) == 1, "poll");
  ExpectPassed(start, 40 * kMs, "an absolute time");
  EXPECT(ReadTimer(real) == 1, "count");
  close(real);

  EXPECT(settime(0, 0, Every(kSecond), nullptr) == -1 && errno != 0, "no timer");
  EXPECT(create(CLOCK_THREAD_CPUTIME_ID, 0) == -1 && errno == EINVAL, "no such clock");
}

void IntervalTimers() {
  g_handled = 0;
  std::int64_t start = Now();
  const itimerval every{{0, 20'000}, {0, 50'000}}, none{};
  itimerval old{};
  EXPECT(syscall(SYS_setitimer, ITIMER_REAL, &every, nullptr) == 0, "%s", strerror(errno));
  AwaitHandled(2);
  ExpectPassed(start, 70 * kMs, "setitimer");
  EXPECT(syscall(SYS_getitimer, ITIMER_REAL, &old) == 0 && old.it_interval.tv_usec == 20'000 &&
             old.it_value.tv_usec > 0 && old.it_value.tv_usec <= 20'000,
         "getitimer: %ld", (long)old.it_value.tv_usec);
  // The same timer by symbol.
  EXPECT(setitimer(ITIMER_REAL, &none, &old) == 0 && old.it_interval.tv_usec == 20'000,
         "setitimer");
  EXPECT(syscall(SYS_setitimer, 9, &every, nullptr) == -1 && errno == EINVAL, "no such timer");
  g_handled = 0;
  start = Now();
  EXPECT(syscall(SYS_alarm, 5) == 0 && syscall(SYS_alarm, 1) == 5, "alarm");
  AwaitHandled(1);
  ExpectPassed(start, kSecond, "alarm");
  EXPECT(syscall(SYS_alarm, 0) == 0, "alarm");
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  struct sigaction action {};
  action.sa_sigaction = Handle;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGUSR1, &action, nullptr);
  sigaction(SIGALRM, &action, nullptr);
  PosixTimers();
  Descriptors(Made::kRaw, Made::kRaw);
  Descriptors(Made::kRaw, Made::kBySymbol);
  Descriptors(Made::kBySymbol, Made::kRaw);
  IntervalTimers();
}
