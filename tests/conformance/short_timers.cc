// Timers of intervals too short for each expiration to be seen: they are counted, by all kinds of
// timers, and the program gets on.
#include <poll.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/time.h>
#include <sys/timerfd.h>

#include <atomic>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

constexpr std::int64_t kIntervals[] = {1, 1'000, 50'000};
std::atomic<int> g_signals{0};

void Count(int) { ++g_signals; }

void Handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  EXPECT(sigaction(signal, &action, nullptr) == 0, "sigaction");
}

int Descriptor(std::int64_t interval_ns, int flags = 0) {
  const int fd = timerfd_create(CLOCK_MONOTONIC, flags);
  const itimerspec spec{ToTimespec(interval_ns), ToTimespec(interval_ns)};
  EXPECT(timerfd_settime(fd, 0, &spec, nullptr) == 0, "%s", strerror(errno));
  return fd;
}

std::int64_t Expirations(int fd) {
  std::uint64_t count = 0;
  EXPECT(read(fd, &count, sizeof count) == sizeof count, "read: %s", strerror(errno));
  return static_cast<std::int64_t>(count);
}

// What has expired since `start` on a timer that was read last before it: neither less nor more.
void ExpectCount(std::int64_t count, std::int64_t least_ns, std::int64_t most_ns,
                 std::int64_t interval_ns, const char* what) {
  EXPECT(count >= least_ns / interval_ns - 1 && count <= most_ns / interval_ns + 1,
         "%s, every %lld ns: %lld in %lld to %lld ns", what, (long long)interval_ns,
         (long long)count, (long long)least_ns, (long long)most_ns);
}

// Days that nobody looks are over at once.
void DescriptorsAreReadAtOnce() {
  const std::int64_t sleep_ns = g_mode == Mode::kNative ? 20 * kMs : 36'000 * kSecond;
  for (const std::int64_t interval : kIntervals) {
    const std::int64_t before = Now();
    const int fd = Descriptor(interval);
    const std::int64_t set = Now();
    const timespec sleep_time = ToTimespec(sleep_ns);
    EXPECT(nanosleep(&sleep_time, nullptr) == 0, "nanosleep");
    const std::int64_t asked = Now();
    const std::int64_t count = Expirations(fd);
    const std::int64_t read_ns = Now();
    ExpectCount(count, asked - set, read_ns - before, interval, "after a sleep");
    // And while it computes.
    const std::int64_t again = Now();
    while (Now() < again + 10 * kMs) {
    }
    const std::int64_t computed = Now();
    const std::int64_t more = Expirations(fd);
    ExpectCount(more, computed - read_ns, Now() - asked, interval, "after computing");
    // Setting it forgets what was not read.
    const itimerspec off{};
    EXPECT(timerfd_settime(fd, 0, &off, nullptr) == 0, "off");
    pollfd probe{fd, POLLIN, 0};
    EXPECT(poll(&probe, 1, 0) == 0, "it still expires");
    close(fd);
  }
}

// Whoever waits for such a timer is woken at its next instant.
void ReadersAreWoken() {
  for (const std::int64_t interval : kIntervals) {
    const std::int64_t start = Now();
    const int fd = Descriptor(interval), set = epoll_create1(0);
    epoll_event event{};
    event.events = EPOLLIN;
    EXPECT(epoll_ctl(set, EPOLL_CTL_ADD, fd, &event) == 0, "epoll_ctl");
    std::int64_t all = 0;
    constexpr int kReads = 20;
    for (int i = 0; i < kReads; ++i) {
      if (i % 2 == 0) EXPECT(epoll_wait(set, &event, 1, -1) == 1, "epoll_wait");
      all += Expirations(fd);
    }
    const std::int64_t passed = Now() - start;
    EXPECT(all >= kReads && all <= passed / interval + 1, "%lld in %lld ns", (long long)all,
           (long long)passed);
    if (g_mode == Mode::kMeasured) EXPECT(passed < 60 * kMs, "%lld ns", (long long)passed);
    if (g_mode == Mode::kFixed && interval >= 10'000) {
      EXPECT(passed < (kReads + 2) * interval, "%lld ns", (long long)passed);
    }
    close(set);
    close(fd);
  }
}

// The program computes, and has its handler run now and then.
void HandlersLetTheProgramGetOn() {
  Handle(SIGALRM, Count);
  g_signals = 0;
  // Natively the shortest leaves no time to anything but the handler.
  const suseconds_t interval_us = g_mode == Mode::kNative ? 200 : 1;
  const itimerval often{{0, interval_us}, {0, interval_us}};
  // And others may have the processor all that while, so that it gets one signal for all.
  const clockid_t clock = g_mode == Mode::kNative ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC;
  const std::int64_t start = Now(clock);
  EXPECT(setitimer(ITIMER_REAL, &often, nullptr) == 0, "setitimer");
  while (Now(clock) < start + 20 * kMs) {
  }
  const itimerval off{};
  EXPECT(setitimer(ITIMER_REAL, &off, nullptr) == 0, "setitimer");
  EXPECT(g_signals > 10, "%d signals", g_signals.load());
}

// Signals that nobody takes: one is pending, whatever runs out.
void PendingSignalsWait() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGALRM);
  sigaddset(&signals, SIGUSR1);
  sigprocmask(SIG_BLOCK, &signals, nullptr);
  timer_t timer;
  sigevent event{};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = SIGUSR1;
  EXPECT(timer_create(CLOCK_MONOTONIC, &event, &timer) == 0, "timer_create");
  const itimerspec every_microsecond{ToTimespec(1'000), ToTimespec(1'000)};
  const itimerval often{{0, 1}, {0, 1}};
  const std::int64_t sleep_ns = g_mode == Mode::kNative ? 20 * kMs : 3600 * kSecond;
  const timespec sleep_time = ToTimespec(sleep_ns), none{};
  EXPECT(setitimer(ITIMER_REAL, &often, nullptr) == 0, "setitimer");
  const std::int64_t before = Now();
  EXPECT(timer_settime(timer, 0, &every_microsecond, nullptr) == 0, "timer_settime");
  const std::int64_t set = Now();
  EXPECT(nanosleep(&sleep_time, nullptr) == 0, "a blocked signal ended the sleep");
  const std::int64_t woken = Now();
  siginfo_t info{};
  EXPECT(sigtimedwait(&signals, &info, &none) > 0, "nothing is pending");
  if (info.si_signo != SIGUSR1) {
    EXPECT(sigtimedwait(&signals, &info, &none) == SIGUSR1, "the timer's is not pending");
  }
  const std::int64_t count = timer_getoverrun(timer) + std::int64_t{1};
  const std::int64_t most = Now() - before;
  if (woken - set < INT32_MAX * 1'000ll) {
    ExpectCount(count, woken - set - kMs, most, 1'000, "overruns");
  } else {
    EXPECT(count == INT32_MAX + 1ll, "%lld overruns", (long long)count);
  }
  const itimerval off{};
  setitimer(ITIMER_REAL, &off, nullptr);
  timer_delete(timer);
  while (sigtimedwait(&signals, nullptr, &none) > 0) {
  }
  sigprocmask(SIG_UNBLOCK, &signals, nullptr);
}

// Signals that are ignored change nothing.
void IgnoredSignalsAreNothing() {
  Handle(SIGALRM, SIG_IGN);
  const itimerval often{{0, 1}, {0, 1}};
  EXPECT(setitimer(ITIMER_REAL, &often, nullptr) == 0, "setitimer");
  const std::int64_t sleep_ns = g_mode == Mode::kNative ? 20 * kMs : 3600 * kSecond;
  const std::int64_t start = Now();
  const timespec sleep_time = ToTimespec(sleep_ns);
  EXPECT(nanosleep(&sleep_time, nullptr) == 0, "nanosleep");
  EXPECT(Now() - start >= sleep_ns, "early");
  const itimerval off{};
  setitimer(ITIMER_REAL, &off, nullptr);
}

// The same on processor time.
void ProcessorTimersLetTheProgramGetOn() {
  Handle(SIGPROF, Count);
  g_signals = 0;
  const itimerval often{{0, 1}, {0, 1}};
  EXPECT(setitimer(ITIMER_PROF, &often, nullptr) == 0, "setitimer");
  const std::int64_t start = Now(CLOCK_PROCESS_CPUTIME_ID);
  while (Now(CLOCK_PROCESS_CPUTIME_ID) < start + 50 * kMs) {
  }
  const itimerval off{};
  EXPECT(setitimer(ITIMER_PROF, &off, nullptr) == 0, "setitimer");
  EXPECT(g_signals > 0, "no signals");
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  DescriptorsAreReadAtOnce();
  ReadersAreWoken();
  HandlersLetTheProgramGetOn();
  PendingSignalsWait();
  IgnoredSignalsAreNothing();
  ProcessorTimersLetTheProgramGetOn();
}
