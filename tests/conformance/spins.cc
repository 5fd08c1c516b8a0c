// A thread that spins, on a clock, a flag, a lock or sched_yield, gets on, and stops nobody else,
// even on a computer with one processor.
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/wait.h>

#include <atomic>

#include "tests/conformance/conformance.h"

namespace {

using namespace conformance;

std::atomic<bool> g_flag;

// Sets the flag after 30 ms.
void* SetLater(void* flag) {
  usleep(30'000);
  static_cast<std::atomic<bool>*>(flag)->store(true);
  return nullptr;
}

template <class Spin>
void SpinUntilSet(const char* what, Spin spin) {
  g_flag = false;
  const std::int64_t start = Now();
  pthread_t thread;
  pthread_create(&thread, nullptr, SetLater, &g_flag);
  while (!g_flag) spin();
  EXPECT(Now() - start >= 30 * kMs, "%s: set early", what);
  if (g_mode != Mode::kNative) {
    EXPECT(Now() - start < 60 * kMs, "%s: seen after %lld ns", what, (long long)(Now() - start));
  }
  pthread_join(thread, nullptr);
}

void OtherProcess() {
  auto* flag = static_cast<std::atomic<bool>*>(
      mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  const std::int64_t start = Now();
  const pid_t child = fork();
  if (child == 0) {
    SetLater(flag);
    _exit(0);
  }
  while (!*flag) {
  }
  ExpectSoonAfter(start, 30 * kMs, "another process", 20 * kMs + MostOfChildren());
  waitpid(child, nullptr, 0);
}

void SpinLock() {
  static pthread_spinlock_t lock;
  pthread_spin_init(&lock, PTHREAD_PROCESS_PRIVATE);
  pthread_spin_lock(&lock);
  pthread_t thread;
  pthread_create(
      &thread, nullptr,
      [](void*) -> void* {
        pthread_spin_lock(&lock);
        pthread_spin_unlock(&lock);
        return nullptr;
      },
      nullptr);
  usleep(20'000);
  pthread_spin_unlock(&lock);
  pthread_join(thread, nullptr);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  std::int64_t start = Now();
  while (Now() < start + 10 * kMs) {
  }
  SpinUntilSet("sched_yield", [] { sched_yield(); });
  SpinUntilSet("a clock", [] { Now(); });
  SpinUntilSet("the processor clock", [] { Now(CLOCK_THREAD_CPUTIME_ID); });
  SpinUntilSet("a flag", [] {});
  // Under set costs it takes some real seconds until such a spin is known for one, but only once.
  OtherProcess();
  SpinLock();
}
