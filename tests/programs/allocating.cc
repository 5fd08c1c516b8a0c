// Allocates in each of the ways that there are, and spins on locks, and prints what the clock says
// of each. Before each it waits.
#include <malloc.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

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
void Measure(const char* name, F allocate, int times = kTimes) {
  usleep(1000);
  const long long start = Now();
  for (int i = 0; i < times; ++i) g_block = allocate();
  const long long passed = Now() - start;
  printf("%s %lld\n", name, passed);
}

void* Thread(void*) {
  g_block = malloc(16);  // gives the thread an arena, for which the C library makes calls
  Measure("thread", [] { return malloc(16); });
  return nullptr;
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
  Measure(
      "many", [] { return malloc(16); }, 5 * kTimes);
  // The first thousand in a row cost nothing.
  static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  Measure(
      "mutex",
      [] {
        pthread_mutex_lock(&mutex);
        pthread_mutex_unlock(&mutex);
        return static_cast<void*>(nullptr);
      },
      2 * kTimes);
  static pthread_rwlock_t rwlock = PTHREAD_RWLOCK_INITIALIZER;
  Measure(
      "rwlock",
      [] {
        pthread_rwlock_tryrdlock(&rwlock);
        pthread_rwlock_unlock(&rwlock);
        return static_cast<void*>(nullptr);
      },
      2 * kTimes);
  Measure("locks", [] {
    pthread_mutex_lock(&mutex);
    pthread_mutex_unlock(&mutex);
    return static_cast<void*>(nullptr);
  });
  Measure("computing", [] { return static_cast<void*>(nullptr); });
  pthread_t thread;
  pthread_create(&thread, nullptr, Thread, nullptr);
  pthread_join(thread, nullptr);
}
