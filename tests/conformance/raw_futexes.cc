// Futex calls that the C library does not make: waiting for any of several words, and for a
// condition whose waker hands its waiters on to a lock with an owner.
#include <limits.h>
#include <linux/futex.h>
#include <pthread.h>
#include <signal.h>
#include <sys/syscall.h>

#include <atomic>

#include "tests/conformance/conformance.h"
#include "tests/conformance/natively_until.h"

namespace {

using namespace conformance;

using Word = std::atomic<std::uint32_t>;

// Of linux/futex.h since 5.16.
struct Waited {
  std::uint64_t value, address;
  std::uint32_t flags, reserved;
};

long Futex(Word& word, int command, std::uint32_t value, const timespec* timeout = nullptr,
           Word* second = nullptr, std::uint32_t third = 0) {
  return syscall(SYS_futex, &word, command, value, timeout, second, third);
}

void SleepUntil(std::int64_t until) {
  const timespec t = ToTimespec(until);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
}

template <class Body>
pthread_t Thread(Body body) {
  pthread_t thread;
  pthread_create(
      &thread, nullptr,
      [](void* its) -> void* {
        auto* copy = static_cast<Body*>(its);
        (*copy)();
        delete copy;
        return nullptr;
      },
      new Body(body));
  return thread;
}

Word g_words[3];

long WaitForAny(std::uint32_t flags, const timespec* until, clockid_t clock = CLOCK_MONOTONIC) {
  Waited waited[3];
  for (int i = 0; i < 3; ++i) {
    waited[i] = {0, reinterpret_cast<std::uint64_t>(&g_words[i]), flags, 0};
  }
  return syscall(SYS_futex_waitv, waited, 3, 0, until, clock);
}

void Several() {
  constexpr std::uint32_t k32 = 2;
  for (const std::uint32_t flags : {k32, k32 | FUTEX_PRIVATE_FLAG}) {
    const int private_too = (flags & FUTEX_PRIVATE_FLAG) != 0 ? FUTEX_PRIVATE_FLAG : 0;
    for (int which = 0; which < 3; ++which) {
      const std::int64_t start = Now();
      const pid_t waiter = gettid();
      const pthread_t waker = Thread([=] {
        SleepUntil(start + 50 * kMs);
        NativelyUntil([=] { return Sleeps(waiter); });
        EXPECT(Futex(g_words[which], FUTEX_WAKE | private_too, INT_MAX) == 1, "nobody woken");
      });
      const long woken = WaitForAny(flags, nullptr);
      EXPECT(woken == which, "%ld instead of %d: %s", woken, which, strerror(errno));
      ExpectPassed(start, 50 * kMs, "one of several");
      pthread_join(waker, nullptr);
    }
  }
  // To a time on either clock.
  for (const clockid_t clock : {CLOCK_MONOTONIC, CLOCK_REALTIME}) {
    const std::int64_t start = Now();
    const timespec until = ToTimespec(Now(clock) + 40 * kMs);
    EXPECT(WaitForAny(k32, &until, clock) == -1 && errno == ETIMEDOUT, "%s", strerror(errno));
    ExpectPassed(start, 40 * kMs, "a timeout");
  }
  g_words[1] = 7;
  EXPECT(WaitForAny(k32, nullptr) == -1 && errno == EAGAIN, "%s", strerror(errno));
  g_words[1] = 0;
  EXPECT(WaitForAny(0, nullptr) == -1 && errno == EINVAL, "%s", strerror(errno));
  EXPECT(syscall(SYS_futex_waitv, nullptr, 1, 0, nullptr, 0) == -1 && errno == EINVAL, "%s",
         strerror(errno));
}

Word g_condition, g_lock;

void Lock() {
  std::uint32_t free = 0;
  if (g_lock.compare_exchange_strong(free, static_cast<std::uint32_t>(syscall(SYS_gettid)))) return;
  EXPECT(Futex(g_lock, FUTEX_LOCK_PI, 0) == 0, "%s", strerror(errno));
}

void Unlock() {
  auto own = static_cast<std::uint32_t>(syscall(SYS_gettid));
  if (g_lock.compare_exchange_strong(own, 0)) return;
  EXPECT(Futex(g_lock, FUTEX_UNLOCK_PI, 0) == 0, "%s", strerror(errno));
}

long WaitForLock(const timespec* until = nullptr) {
  return Futex(g_condition, FUTEX_WAIT_REQUEUE_PI, 0, until, &g_lock);
}

long HandOn(int most) {
  return Futex(g_condition, FUTEX_CMP_REQUEUE_PI, 1,
               reinterpret_cast<const timespec*>(static_cast<long>(most)), &g_lock, 0);
}

bool Holds() {
  return (g_lock & FUTEX_TID_MASK) == static_cast<std::uint32_t>(syscall(SYS_gettid));
}

// Three wait; their waker has the lock meanwhile, or does not.
void Condition(bool held) {
  static std::atomic<int> had;
  had = 0;
  InOrder waiters;
  const std::int64_t start = Now();
  pthread_t threads[3];
  for (int i = 0; i < 3; ++i) {
    threads[i] = Thread([=, &waiters] {
      SleepUntil(start + (i + 1) * 10 * kMs);
      waiters.Comes(i);
      EXPECT(WaitForLock() == 0, "%s", strerror(errno));
      EXPECT(Holds(), "without the lock");
      // One after another: each has it for 10 ms.
      ExpectPassed(start, (100 + i * 10) * kMs, "a lock handed on");
      ++had;
      SleepUntil(start + (110 + i * 10) * kMs);
      Unlock();
    });
  }
  SleepUntil(start + 90 * kMs);
  waiters.AwaitAll(3);
  if (held) {
    Lock();
    EXPECT(HandOn(INT_MAX) == 3, "%s", strerror(errno));
    SleepUntil(start + 100 * kMs);
    EXPECT(had == 0, "had early");
    Unlock();
  } else {
    SleepUntil(start + 100 * kMs);
    EXPECT(HandOn(INT_MAX) == 3, "%s", strerror(errno));
  }
  for (const pthread_t thread : threads) pthread_join(thread, nullptr);
  EXPECT(had == 3 && g_lock == 0, "%d had it, %x", had.load(), g_lock.load());
}

// By its time, before and after it was handed on.
void Timeouts() {
  const std::int64_t start = Now();
  timespec until = ToTimespec(start + 30 * kMs);
  EXPECT(WaitForLock(&until) == -1 && errno == ETIMEDOUT, "%s", strerror(errno));
  ExpectPassed(start, 30 * kMs, "a condition's timeout");
  Lock();
  // Natively a busy machine may be late.
  const std::int64_t end = start + (g_mode == Mode::kNative ? 2'000 : 100) * kMs;
  InOrder waiters;
  const pthread_t thread = Thread([=, &waiters] {
    const timespec at = ToTimespec(end);
    waiters.Comes(0);
    EXPECT(WaitForLock(&at) == -1 && errno == ETIMEDOUT, "%s", strerror(errno));
    ExpectPassed(start, end - start, "a lock's timeout");
  });
  SleepUntil(start + 60 * kMs);
  waiters.AwaitAll(1);
  EXPECT(HandOn(INT_MAX) == 1, "%s", strerror(errno));
  pthread_join(thread, nullptr);
  Unlock();
}

void Refused() {
  EXPECT(Futex(g_condition, FUTEX_WAIT_REQUEUE_PI, 1, nullptr, &g_lock) == -1 && errno == EAGAIN,
         "%s", strerror(errno));
  EXPECT(
      Futex(g_condition, FUTEX_WAIT_REQUEUE_PI, 0, nullptr, &g_condition) == -1 && errno == EINVAL,
      "%s", strerror(errno));
  EXPECT(Futex(g_condition, FUTEX_CMP_REQUEUE_PI, 2, nullptr, &g_lock) == -1 && errno == EINVAL,
         "%s", strerror(errno));
  EXPECT(Futex(g_condition, FUTEX_CMP_REQUEUE_PI, 1, nullptr, &g_lock, 1) == -1 && errno == EAGAIN,
         "%s", strerror(errno));
  EXPECT(HandOn(1) == 0, "%s", strerror(errno));
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  Several();
  Condition(false);
  Condition(true);
  Timeouts();
  Refused();
}
