// Threads that compute, as many as the robot has cores and more, keep no equal one from its sleeps:
// it goes before them when it wakes, as on Linux. But not if it has had its share: who computes,
// sleeps for a moment and computes again gets no more than who never sleeps.
#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <vector>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

constexpr int kComputing = 4, kSleeps = 100;

std::atomic<bool> g_done{false};

void* Compute(void* used) {
  while (!g_done) Now();
  *static_cast<std::int64_t*>(used) = Now(CLOCK_THREAD_CPUTIME_ID);
  return nullptr;
}

void* ComputeWithPauses(void* used) {
  while (!g_done) {
    const std::int64_t start = Now(CLOCK_THREAD_CPUTIME_ID);
    while (Now(CLOCK_THREAD_CPUTIME_ID) < start + kMs) {
    }
    usleep(1);
  }
  *static_cast<std::int64_t*>(used) = Now(CLOCK_THREAD_CPUTIME_ID);
  return nullptr;
}

// Runs the routines beside `meanwhile`, which is the first thread's; what each has used.
template <class Meanwhile>
std::vector<std::int64_t> Beside(const std::vector<void* (*)(void*)>& routines,
                                 Meanwhile meanwhile) {
  std::vector<std::int64_t> used(routines.size());
  std::vector<pthread_t> threads(routines.size());
  g_done = false;
  for (std::size_t i = 0; i < routines.size(); ++i) {
    EXPECT(pthread_create(&threads[i], nullptr, routines[i], &used[i]) == 0, "pthread_create");
  }
  meanwhile();
  g_done = true;
  for (const pthread_t thread : threads) pthread_join(thread, nullptr);
  return used;
}

void SleepOften() {
  int late = 0;
  std::int64_t worst = 0;
  for (int i = 0; i < kSleeps; ++i) {
    const std::int64_t start = Now();
    usleep(1'000);
    const std::int64_t passed = Now() - start;
    EXPECT(passed >= kMs, "a sleep of 1 ms took %lld ns", (long long)passed);
    worst = std::max(worst, passed);
    if (passed > kMs + kMs / 2) ++late;
  }
  // A turn of one of the others would be 1 ms. Where it is measured, interrupts of the host's come.
  const int most = g_mode == Mode::kFixed ? 2 : 10;
  if (g_mode != Mode::kNative)
    EXPECT(late <= most, "%d of %d sleeps were late, the worst took %lld ns", late, kSleeps,
           (long long)worst);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  for (const int computing : {1, kComputing, kComputing + 1}) {
    Beside(std::vector<void* (*)(void*)>(static_cast<std::size_t>(computing), Compute), SleepOften);
  }
  // As many as there are cores, twice.
  const int cores = argc > 2 ? atoi(argv[2]) : 1;
  std::vector<void* (*)(void*)> both(static_cast<std::size_t>(cores), Compute);
  both.insert(both.end(), static_cast<std::size_t>(cores), ComputeWithPauses);
  const std::vector<std::int64_t> used = Beside(both, [] { usleep(200'000); });
  std::int64_t all = 0, pausing = 0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    all += used[i];
    if (i >= used.size() / 2) pausing += used[i];
  }
  if (g_mode != Mode::kNative)
    EXPECT(pausing > all * 2 / 5 && pausing < all * 3 / 5, "who pauses used %lld of %lld ns",
           (long long)pausing, (long long)all);
}
