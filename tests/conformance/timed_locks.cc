// All of the C library's timed waits for threads, on both clocks: each ends at its deadline.
#include <pthread.h>
#include <semaphore.h>
#include <threads.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

constexpr std::int64_t kWait = 25 * kMs;

template <class Wait>
void ExpectTimeout(const char* what, clockid_t clock, int wanted, Wait wait) {
  const std::int64_t start = Now();
  const timespec deadline = ToTimespec(Now(clock) + kWait);
  const int error = wait(&deadline);
  EXPECT(error == wanted, "%s returned %d", what, error);
  const std::int64_t passed = Now() - start;
  EXPECT(passed >= kWait - kMs * (g_mode == Mode::kNative), "%s took %lld ns, which is early", what,
         (long long)passed);
  if (g_mode != Mode::kNative) {
    EXPECT(passed < kWait + (g_mode == Mode::kFixed ? 1 : 10) * kMs, "%s took %lld ns", what,
           (long long)passed);
  }
}

void* InThread(void* argument) {
  (*static_cast<void (**)()>(argument))();
  return nullptr;
}

// A lock that another thread holds.
pthread_mutex_t g_mutex = PTHREAD_MUTEX_INITIALIZER;
pthread_rwlock_t g_rwlock = PTHREAD_RWLOCK_INITIALIZER;
mtx_t g_mtx;

void Contend() {
  ExpectTimeout("pthread_mutex_timedlock", CLOCK_REALTIME, ETIMEDOUT,
                [](const timespec* t) { return pthread_mutex_timedlock(&g_mutex, t); });
  ExpectTimeout("pthread_rwlock_timedrdlock", CLOCK_REALTIME, ETIMEDOUT,
                [](const timespec* t) { return pthread_rwlock_timedrdlock(&g_rwlock, t); });
  ExpectTimeout("pthread_rwlock_timedwrlock", CLOCK_REALTIME, ETIMEDOUT,
                [](const timespec* t) { return pthread_rwlock_timedwrlock(&g_rwlock, t); });
  ExpectTimeout("mtx_timedlock", CLOCK_REALTIME, thrd_timedout,
                [](const timespec* t) { return mtx_timedlock(&g_mtx, t); });
  for (const clockid_t clock : {CLOCK_REALTIME, CLOCK_MONOTONIC}) {
    ExpectTimeout("pthread_mutex_clocklock", clock, ETIMEDOUT,
                  [=](const timespec* t) { return pthread_mutex_clocklock(&g_mutex, clock, t); });
    ExpectTimeout("pthread_rwlock_clockrdlock", clock, ETIMEDOUT, [=](const timespec* t) {
      return pthread_rwlock_clockrdlock(&g_rwlock, clock, t);
    });
    ExpectTimeout("pthread_rwlock_clockwrlock", clock, ETIMEDOUT, [=](const timespec* t) {
      return pthread_rwlock_clockwrlock(&g_rwlock, clock, t);
    });
  }
}

void Conditions() {
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  pthread_mutex_lock(&mutex);
  for (const clockid_t clock : {CLOCK_REALTIME, CLOCK_MONOTONIC}) {
    pthread_condattr_t attributes;
    pthread_condattr_init(&attributes);
    EXPECT(pthread_condattr_setclock(&attributes, clock) == 0, "pthread_condattr_setclock");
    pthread_cond_t condition;
    pthread_cond_init(&condition, &attributes);
    ExpectTimeout("pthread_cond_timedwait", clock, ETIMEDOUT,
                  [&](const timespec* t) { return pthread_cond_timedwait(&condition, &mutex, t); });
    ExpectTimeout("pthread_cond_clockwait", clock, ETIMEDOUT, [&](const timespec* t) {
      return pthread_cond_clockwait(&condition, &mutex, clock, t);
    });
  }
  mtx_t mtx;
  cnd_t cnd;
  mtx_init(&mtx, mtx_plain);
  cnd_init(&cnd);
  mtx_lock(&mtx);
  ExpectTimeout("cnd_timedwait", CLOCK_REALTIME, thrd_timedout,
                [&](const timespec* t) { return cnd_timedwait(&cnd, &mtx, t); });
}

void Semaphores() {
  sem_t semaphore;
  sem_init(&semaphore, 0, 0);
  ExpectTimeout("sem_timedwait", CLOCK_REALTIME, ETIMEDOUT,
                [&](const timespec* t) { return sem_timedwait(&semaphore, t) == 0 ? 0 : errno; });
  for (const clockid_t clock : {CLOCK_REALTIME, CLOCK_MONOTONIC}) {
    ExpectTimeout("sem_clockwait", clock, ETIMEDOUT, [&](const timespec* t) {
      return sem_clockwait(&semaphore, clock, t) == 0 ? 0 : errno;
    });
  }
}

void Joins() {
  void (*sleeps)() = [] { usleep(500'000); };
  pthread_t thread;
  const std::int64_t start = Now();
  EXPECT(pthread_create(&thread, nullptr, InThread, reinterpret_cast<void*>(&sleeps)) == 0,
         "pthread_create");
  ExpectTimeout("pthread_timedjoin_np", CLOCK_REALTIME, ETIMEDOUT,
                [&](const timespec* t) { return pthread_timedjoin_np(thread, nullptr, t); });
  for (const clockid_t clock : {CLOCK_REALTIME, CLOCK_MONOTONIC}) {
    ExpectTimeout("pthread_clockjoin_np", clock, ETIMEDOUT, [&](const timespec* t) {
      return pthread_clockjoin_np(thread, nullptr, clock, t);
    });
  }
  EXPECT(pthread_tryjoin_np(thread, nullptr) == EBUSY, "pthread_tryjoin_np");
  EXPECT(pthread_join(thread, nullptr) == 0, "pthread_join");
  ExpectSoonAfter(start, 500 * kMs, "the thread");
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  pthread_mutex_lock(&g_mutex);
  pthread_rwlock_wrlock(&g_rwlock);
  mtx_init(&g_mtx, mtx_timed);
  mtx_lock(&g_mtx);
  void (*contend)() = Contend;
  pthread_t thread;
  pthread_create(&thread, nullptr, InThread, reinterpret_cast<void*>(&contend));
  pthread_join(thread, nullptr);
  Conditions();
  Semaphores();
  Joins();
}
