// Allocates, and takes locks, in each of the ways that there are, and prints what the clock says of
// each.
#include <malloc.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <threads.h>
#include <time.h>

namespace {

constexpr int kTimes = 1000;

long long Now() {
  timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000ll + now.tv_nsec;
}

// The compiler must not take them away.
void* volatile g_block;

template <class F>
void Measure(const char* name, F allocate) {
  const long long start = Now();
  for (int i = 0; i < kTimes; ++i) g_block = allocate();
  const long long passed = Now() - start;
  printf("%s %lld\n", name, passed);
}

void* Thread(void*) {
  g_block = malloc(16);  // gives the thread an arena, for which the C library makes calls
  Measure("thread", [] { return malloc(16); });
  return nullptr;
}

// A lock that is held is asked for in vain, which costs the same.
void Lock() {
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  pthread_rwlock_t rwlock = PTHREAD_RWLOCK_INITIALIZER;
  pthread_spinlock_t spin;
  pthread_spin_init(&spin, PTHREAD_PROCESS_PRIVATE);
  mtx_t mtx;
  mtx_init(&mtx, mtx_plain);
  const auto measure = [](const char* name, auto lock, auto unlock) {
    Measure(name, [&] {
      lock();
      unlock();
      return static_cast<void*>(nullptr);
    });
  };
  const auto nothing = [] {};
  const auto unlock = [&] { pthread_mutex_unlock(&mutex); };
  measure(
      "pthread_mutex_lock", [&] { pthread_mutex_lock(&mutex); }, unlock);
  measure(
      "pthread_mutex_trylock", [&] { pthread_mutex_trylock(&mutex); }, nothing);
  const auto release = [&] { pthread_rwlock_unlock(&rwlock); };
  measure(
      "pthread_rwlock_rdlock", [&] { pthread_rwlock_rdlock(&rwlock); }, release);
  measure(
      "pthread_rwlock_tryrdlock", [&] { pthread_rwlock_tryrdlock(&rwlock); }, release);
  measure(
      "pthread_rwlock_wrlock", [&] { pthread_rwlock_wrlock(&rwlock); }, release);
  measure(
      "pthread_rwlock_trywrlock", [&] { pthread_rwlock_trywrlock(&rwlock); }, nothing);
  measure(
      "pthread_spin_lock", [&] { pthread_spin_lock(&spin); }, [&] { pthread_spin_unlock(&spin); });
  measure(
      "pthread_spin_trylock", [&] { pthread_spin_trylock(&spin); }, nothing);
  measure(
      "mtx_lock", [&] { mtx_lock(&mtx); }, [&] { mtx_unlock(&mtx); });
  measure(
      "mtx_trylock", [&] { mtx_trylock(&mtx); }, nothing);
}

}  // namespace

int main() {
  static char buffer[4096];
  setvbuf(stdout, buffer, _IOFBF, sizeof buffer);
  Measure("malloc", [] { return malloc(16); });
  Measure("calloc", [] { return calloc(2, 8); });
  Measure("realloc", [] { return realloc(g_block, 40); });
  Measure("reallocarray", [] { return reallocarray(g_block, 4, 20); });
  Measure("aligned_alloc", [] { return aligned_alloc(64, 64); });
  Measure("memalign", [] { return memalign(64, 64); });
  Measure("posix_memalign", [] {
    void* block = nullptr;
    return posix_memalign(&block, 64, 64) == 0 ? block : nullptr;
  });
  Measure("new", [] { return static_cast<void*>(new char[16]); });
  Measure("computing", [] { return static_cast<void*>(nullptr); });
  Lock();
  pthread_t thread;
  pthread_create(&thread, nullptr, Thread, nullptr);
  pthread_join(thread, nullptr);
}
