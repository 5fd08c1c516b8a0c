// SCHED_DEADLINE: a thread that has a runtime and a period precedes all others, gets its runtime in
// each period, and no more while others want the processor. What sched_setattr sets, sched_getattr
// reports, and what no processor could keep is refused.
#include <pthread.h>
#include <sched.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <atomic>

#include "tests/conformance/conformance.h"
#include "tests/conformance/rights.h"

namespace {

using namespace conformance;

constexpr std::uint32_t kDeadline = 6;  // SCHED_DEADLINE

struct Attributes {
  std::uint32_t size = 48, policy = kDeadline;
  std::uint64_t flags = 0;
  std::int32_t nice = 0;
  std::uint32_t priority = 0;
  std::uint64_t runtime = 0, deadline = 0, period = 0;
};

long Set(Attributes attributes) { return syscall(SYS_sched_setattr, 0, &attributes, 0); }

long Set(std::int64_t runtime, std::int64_t deadline, std::int64_t period) {
  Attributes attributes;
  attributes.runtime = static_cast<std::uint64_t>(runtime);
  attributes.deadline = static_cast<std::uint64_t>(deadline);
  attributes.period = static_cast<std::uint64_t>(period);
  return Set(attributes);
}

void BecomeOrdinary() {
  Attributes attributes;
  attributes.policy = SCHED_OTHER;
  EXPECT(Set(attributes) == 0, "%s", strerror(errno));
}

void ExpectRefused(int error, std::int64_t runtime, std::int64_t deadline, std::int64_t period,
                   const char* why) {
  EXPECT(Set(runtime, deadline, period) == -1, "%s is allowed", why);
  EXPECT(errno == error, "%s: %s", why, strerror(errno));
}

void WhatIsSetIsReported() {
  EXPECT(Set(2 * kMs, 8 * kMs, 10 * kMs) == 0, "%s", strerror(errno));
  Attributes is;
  EXPECT(syscall(SYS_sched_getattr, 0, &is, sizeof is, 0) == 0, "%s", strerror(errno));
  EXPECT(is.policy == kDeadline && is.runtime == 2 * kMs && is.deadline == 8 * kMs &&
             is.period == 10 * kMs && is.priority == 0,
         "policy %u, %llu in %llu of %llu, priority %u", is.policy, (unsigned long long)is.runtime,
         (unsigned long long)is.deadline, (unsigned long long)is.period, is.priority);
  EXPECT(sched_getscheduler(0) == kDeadline, "%d", sched_getscheduler(0));
  EXPECT(Set(2 * kMs, 8 * kMs, 0) == 0, "%s", strerror(errno));
  EXPECT(syscall(SYS_sched_getattr, 0, &is, sizeof is, 0) == 0 && is.period == 8 * kMs,
         "a period that is not given is %llu", (unsigned long long)is.period);
  BecomeOrdinary();
  EXPECT(syscall(SYS_sched_getattr, 0, &is, sizeof is, 0) == 0 && is.policy == SCHED_OTHER,
         "policy %u", is.policy);
}

void WhatCannotBeKeptIsRefused() {
  ExpectRefused(EINVAL, 0, 0, 0, "nothing at all");
  ExpectRefused(EINVAL, 1000, 10 * kMs, 10 * kMs, "a runtime of 1 us");
  ExpectRefused(EINVAL, 9 * kMs, 8 * kMs, 10 * kMs, "a runtime beyond the deadline");
  ExpectRefused(EINVAL, 2 * kMs, 12 * kMs, 10 * kMs, "a deadline beyond the period");
  ExpectRefused(EINVAL, 20'000, 50'000, 50'000, "a period of 50 us");
  ExpectRefused(EINVAL, -1, 10 * kMs, 10 * kMs, "a runtime without bounds");
  const sched_param none{0};
  EXPECT(sched_setscheduler(0, static_cast<int>(kDeadline), &none) == -1 && errno == EINVAL,
         "without parameters: %s", strerror(errno));
  Attributes urgent;
  urgent.runtime = kMs;
  urgent.deadline = urgent.period = 10 * kMs;
  urgent.priority = 1;
  EXPECT(Set(urgent) == -1 && errno == EINVAL, "with a priority: %s", strerror(errno));
}

// Another thread computes without end; the one with a deadline computes as much as it can for ten
// periods of 10 ms, of which it has 3 ms each. Under tcs, one processor: it has had 30 ms.
std::atomic<bool> g_stop{false};

void* Compute(void*) {
  while (!g_stop.load()) Now();
  return nullptr;
}

void TheRuntimeIsKept() {
  pthread_t other;
  EXPECT(pthread_create(&other, nullptr, Compute, nullptr) == 0, "%s", strerror(errno));
  EXPECT(Set(3 * kMs, 10 * kMs, 10 * kMs) == 0, "%s", strerror(errno));
  const std::int64_t start = Now(), ran = Now(CLOCK_THREAD_CPUTIME_ID);
  while (Now() < start + 100 * kMs) {
  }
  const std::int64_t had = Now(CLOCK_THREAD_CPUTIME_ID) - ran;
  BecomeOrdinary();
  g_stop.store(true);
  pthread_join(other, nullptr);
  // Natively the kernel lets it overrun, by a tick.
  if (g_mode == Mode::kNative) return;
  // A thread's clock may have been ahead of what it had computed, and its last turn may end late.
  const std::int64_t slack = g_mode == Mode::kMeasured ? 2 * kMs : kMs;
  EXPECT(had >= 30 * kMs - slack / 10 && had <= 30 * kMs + slack, "it has had %lld ns of 30 ms",
         (long long)had);
}

// It has slept, while another thread of SCHED_FIFO 99 computes, and has the processor in the
// instant in which it wakes.
void ItPrecedesEverybody() {
  if (g_mode == Mode::kNative) return;  // several processors
  g_stop.store(false);
  pthread_t other;
  const sched_param most{99};
  EXPECT(pthread_create(&other, nullptr, Compute, nullptr) == 0, "%s", strerror(errno));
  EXPECT(Set(3 * kMs, 10 * kMs, 10 * kMs) == 0, "%s", strerror(errno));
  EXPECT(pthread_setschedparam(other, SCHED_FIFO, &most) == 0, "%s", strerror(errno));
  for (int i = 0; i < 10; ++i) {
    const std::int64_t until = Now() + 10 * kMs;
    const timespec t = ToTimespec(until);
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr);
    const std::int64_t late = Now() - until;
    EXPECT(late >= 0 && late <= (g_mode == Mode::kFixed ? 2 * kCallNs : 3 * kMs), "%lld ns late",
           (long long)late);
  }
  g_stop.store(true);
  pthread_join(other, nullptr);
  BecomeOrdinary();
}

// A yield ends the period's work: the next time that it runs, the next period has begun.
void AYieldWaitsForTheNextPeriod() {
  if (g_mode == Mode::kNative) return;
  const std::int64_t start = Now();
  EXPECT(Set(3 * kMs, 10 * kMs, 10 * kMs) == 0, "%s", strerror(errno));
  const std::int64_t released = Now();
  for (int i = 0; i < 5; ++i) sched_yield();
  const std::int64_t now = Now();
  EXPECT(now >= start + 50 * kMs && now < released + 50 * kMs + kMs, "%lld ns for 5 periods",
         (long long)(now - start));
  BecomeOrdinary();
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  if (Set(kMs, 10 * kMs, 10 * kMs) != 0) {
    // Natively it takes CAP_SYS_NICE, and every processor of the host.
    EXPECT(g_mode == Mode::kNative || errno == EPERM, "%s", strerror(errno));
    const bool may = HasCapability(CAP_SYS_NICE) && !AreRealTimeCallsFiltered();
    return g_mode == Mode::kNative || !may ? 0 : 1;
  }
  BecomeOrdinary();
  WhatIsSetIsReported();
  WhatCannotBeKeptIsRefused();
  TheRuntimeIsKept();
  ItPrecedesEverybody();
  AYieldWaitsForTheNextPeriod();
}
