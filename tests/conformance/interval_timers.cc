// setitimer, getitimer and alarm, on all three clocks.
#include <limits.h>
#include <signal.h>
#include <sys/time.h>

#include <atomic>
#include <thread>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

volatile sig_atomic_t g_count = 0;
std::int64_t g_at[64];

void Note(int) {
  if (g_count < 64) g_at[g_count] = Now();
  g_count = g_count + 1;
}

// Under tcs; where it is measured an interrupt of the host's may come in between.
std::int64_t MostLate() { return (g_mode == Mode::kMeasured ? 5 : 1) * kMs; }

void WaitFor(int count) {
  while (g_count < count) usleep(1'000'000);
}

itimerval Every(std::int64_t first_ns, std::int64_t then_ns) {
  return {{then_ns / kSecond, then_ns % kSecond / 1000},
          {first_ns / kSecond, first_ns % kSecond / 1000}};
}

void OnceAndAgain() {
  g_count = 0;
  std::int64_t start = Now();
  itimerval timer = Every(30 * kMs, 0);
  EXPECT(setitimer(ITIMER_REAL, &timer, nullptr) == 0, "setitimer");
  WaitFor(1);
  EXPECT(g_at[0] - start >= 30 * kMs, "after %lld ns", (long long)(g_at[0] - start));
  if (g_mode != Mode::kNative) EXPECT(g_at[0] - start < 30 * kMs + MostLate(), "late");
  usleep(100'000);
  EXPECT(g_count == 1, "a one-shot timer fired %d times", int(g_count));

  g_count = 0;
  start = Now();
  timer = Every(20 * kMs, 10 * kMs);
  setitimer(ITIMER_REAL, &timer, nullptr);
  WaitFor(5);
  for (int i = 0; i < 5; ++i) {
    const std::int64_t after = g_at[i] - start, due = 20 * kMs + i * 10 * kMs;
    EXPECT(after >= due, "expiry %d came after %lld ns", i, (long long)after);
    if (g_mode != Mode::kNative)
      EXPECT(after < due + MostLate(), "expiry %d after %lld ns", i, (long long)after);
  }
  itimerval left{};
  EXPECT(getitimer(ITIMER_REAL, &left) == 0, "getitimer");
  EXPECT(left.it_interval.tv_usec == 10'000, "interval %ld us", left.it_interval.tv_usec);
  EXPECT(left.it_value.tv_usec > 0 && left.it_value.tv_usec <= 10'000, "%ld us",
         left.it_value.tv_usec);
  const itimerval off{};
  itimerval old{};
  EXPECT(setitimer(ITIMER_REAL, &off, &old) == 0, "setitimer");
  EXPECT(old.it_interval.tv_usec == 10'000, "interval %ld us", old.it_interval.tv_usec);
  const int count = g_count;
  usleep(50'000);
  EXPECT(g_count == count, "a timer that was taken away fired");
}

void Alarms() {
  g_count = 0;
  const std::int64_t start = Now();
  EXPECT(alarm(2) == 0, "no alarm was set");
  const unsigned left = alarm(1);
  EXPECT(left >= 1 && left <= 2, "alarm says %u s were left", left);
  WaitFor(1);
  EXPECT(g_at[0] - start >= kSecond, "after %lld ns", (long long)(g_at[0] - start));
  if (g_mode != Mode::kNative) EXPECT(g_at[0] - start < kSecond + MostLate(), "late");
  alarm(1);
  EXPECT(alarm(0) == 1, "an alarm just set");
}

void Microseconds() {
  g_count = 0;
  const std::int64_t start = Now();
  EXPECT(ualarm(20'000, 10'000) == 0, "no alarm was set");
  WaitFor(3);
  for (int i = 0; i < 3; ++i) {
    const std::int64_t after = g_at[i] - start, due = (20 + 10 * i) * kMs;
    EXPECT(after >= due, "expiry %d came after %lld ns", i, (long long)after);
    if (g_mode == Mode::kMeasured)
      EXPECT(after < due + MostLate(), "expiry %d after %lld ns", i, (long long)after);
    if (g_mode == Mode::kFixed)
      EXPECT(after <= due + 5 * kCallNs, "expiry %d after %lld ns", i, (long long)after);
  }
  const useconds_t left = ualarm(0, 0);
  EXPECT(left > 0 && left <= 10'000, "%u us were left", left);
  const int count = g_count;
  usleep(30'000);
  EXPECT(g_count == count, "an alarm that was taken away came");
}

// Fires by processor time, which a sleep does not use.
void OnProcessorTime(int which, int signal_number) {
  if (g_mode == Mode::kFixed) return;  // computing is free there
  signal(signal_number, Note);
  g_count = 0;
  const itimerval timer = Every(50 * kMs, 0);
  const std::int64_t cpu = Now(CLOCK_PROCESS_CPUTIME_ID);
  EXPECT(setitimer(which, &timer, nullptr) == 0, "setitimer %d", which);
  usleep(200'000);
  EXPECT(g_count == 0, "a sleep counted for timer %d", which);
  volatile unsigned sink = 0;
  while (g_count == 0 && Now(CLOCK_PROCESS_CPUTIME_ID) - cpu < kSecond) sink = sink + 1;
  const std::int64_t used = Now(CLOCK_PROCESS_CPUTIME_ID) - cpu;
  EXPECT(g_count == 1, "timer %d never fired", which);
  // Natively the kernel counts in ticks, and ITIMER_VIRTUAL leaves out what the kernel itself used.
  EXPECT(used >= 40 * kMs && used < 500 * kMs, "timer %d after %lld ns", which, (long long)used);
}

std::atomic<pid_t> g_handler_ran_in{0};

// The thread that computes runs the handler, though the first thread, which waits, does not block
// the signal either, and had it to wait for a turn.
void InWhoComputes(int which, int signal_number) {
  signal(signal_number, [](int) { g_handler_ran_in = gettid(); });
  g_handler_ran_in = 0;
  std::atomic<pid_t> computes{0};
  std::thread worker([&] {
    computes = gettid();
    const itimerval timer = Every(20 * kMs, 0);
    EXPECT(setitimer(which, &timer, nullptr) == 0, "setitimer %d", which);
    const std::int64_t cpu = Now(CLOCK_THREAD_CPUTIME_ID);
    while (g_handler_ran_in == 0 && Now(CLOCK_THREAD_CPUTIME_ID) - cpu < kSecond) {
    }
  });
  worker.join();
  EXPECT(g_handler_ran_in == computes, "timer %d: %d ran the handler instead of %d", which,
         int(g_handler_ran_in), int(computes));
}

}  // namespace

// An interval that ends after all time runs out once, and stays set.
void BeyondAllTime() {
  const int before = g_count;
  const itimerval far{{LONG_MAX / 2, 0}, {0, 1'000}};
  EXPECT(setitimer(ITIMER_REAL, &far, nullptr) == 0, "%s", strerror(errno));
  for (int i = 0; i < 3; ++i) usleep(20'000);
  EXPECT(g_count == before + 1, "%d signals", g_count - before);
  itimerval left{};
  const itimerval off{};
  EXPECT(setitimer(ITIMER_REAL, &off, &left) == 0 && left.it_value.tv_sec > 1'000'000, "not set");
}

int main(int argc, char** argv) {
  Begin(argc, argv);
  signal(SIGALRM, Note);
  OnceAndAgain();
  Alarms();
  Microseconds();
  OnProcessorTime(ITIMER_VIRTUAL, SIGVTALRM);
  OnProcessorTime(ITIMER_PROF, SIGPROF);
  InWhoComputes(ITIMER_VIRTUAL, SIGVTALRM);
  InWhoComputes(ITIMER_PROF, SIGPROF);
  BeyondAllTime();
  const itimerval bad{{0, 0}, {0, 1'000'000}};
  EXPECT(setitimer(ITIMER_REAL, &bad, nullptr) == -1 && errno == EINVAL, "a bad time was taken");
}
