// A thread that computes, asking for the time, leaves the processor to an equal one whose sleep or
// timer is over.
#include <pthread.h>
#include <signal.h>
#include <sys/time.h>

#include <atomic>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

std::atomic<bool> g_done{false};

void* Compute(void*) {
  while (!g_done) Now();
  return nullptr;
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  pthread_t thread;
  EXPECT(pthread_create(&thread, nullptr, Compute, nullptr) == 0, "pthread_create");
  const std::int64_t most_late = (g_mode == Mode::kFixed ? 2 : 4) * kMs;
  for (int i = 0; i < 20; ++i) {
    const std::int64_t start = Now();
    usleep(10'000);
    const std::int64_t passed = Now() - start;
    EXPECT(passed >= 10 * kMs, "a sleep of 10 ms took %lld ns", (long long)passed);
    // No more than a turn of the other, of 1.5 ms at most; measured, interrupts of the host's come.
    if (g_mode != Mode::kNative)
      EXPECT(passed < 10 * kMs + most_late, "a sleep of 10 ms took %lld ns", (long long)passed);
  }
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGALRM);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  const std::int64_t start = Now();
  itimerval timer{};
  timer.it_value.tv_usec = 30'000;
  setitimer(ITIMER_REAL, &timer, nullptr);
  int signal = 0;
  EXPECT(sigwait(&set, &signal) == 0 && signal == SIGALRM, "sigwait");
  const std::int64_t passed = Now() - start;
  EXPECT(passed >= 30 * kMs, "a timer of 30 ms took %lld ns", (long long)passed);
  if (g_mode != Mode::kNative)
    EXPECT(passed < 30 * kMs + most_late, "a timer of 30 ms took %lld ns", (long long)passed);
  g_done = true;
  pthread_join(thread, nullptr);
}
