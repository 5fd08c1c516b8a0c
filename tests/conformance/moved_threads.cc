// Threads of different priorities meet again and again, while the most urgent one moves itself from
// core to core: on each, whoever it displaces goes before the less urgent elsewhere, and all come
// to their meetings.
#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <thread>
#include <vector>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

constexpr int kThreads = 3, kRounds = 6;
constexpr std::int64_t kWork = 5 * kMs;

std::vector<int> Cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  EXPECT(sched_getaffinity(0, sizeof set, &set) == 0, "sched_getaffinity");
  std::vector<int> cores;
  for (int core = 0; core < CPU_SETSIZE && cores.size() < 2; ++core) {
    if (CPU_ISSET(core, &set)) cores.push_back(core);
  }
  return cores;
}

void MoveTo(int core) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(core, &set);
  EXPECT(sched_setaffinity(0, sizeof set, &set) == 0, "sched_setaffinity to %d", core);
}

void Meet(pthread_barrier_t* barrier) {
  const int result = pthread_barrier_wait(barrier);
  EXPECT(result == 0 || result == PTHREAD_BARRIER_SERIAL_THREAD, "pthread_barrier_wait");
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  const std::vector<int> cores = Cores();
  pthread_barrier_t begin, end;
  pthread_barrier_init(&begin, nullptr, kThreads + 1);
  pthread_barrier_init(&end, nullptr, kThreads + 1);
  std::vector<std::thread> threads;
  for (int number = 0; number < kThreads; ++number) {
    threads.emplace_back([&, number] {
      // Without the right to it all are equals, which is no less to be right.
      const sched_param urgency{2 + number};
      sched_setscheduler(0, SCHED_FIFO, &urgency);
      for (int round = 0; round < kRounds; ++round) {
        if (number == kThreads - 1) MoveTo(cores[static_cast<std::size_t>(round) % cores.size()]);
        Meet(&begin);
        const std::int64_t start = Now(CLOCK_THREAD_CPUTIME_ID);
        while (Now(CLOCK_THREAD_CPUTIME_ID) - start < kWork) {
        }
        Meet(&end);
      }
    });
  }
  for (int round = 0; round < kRounds; ++round) {
    // Whoever is less urgent comes to this clock after the work only.
    const std::int64_t start = Now();
    Meet(&begin);
    Meet(&end);
    const std::int64_t took = Now() - start, all = kThreads * kWork;
    if (g_mode == Mode::kNative) continue;  // it may have more cores, and more to do
    const std::int64_t least = all / static_cast<std::int64_t>(cores.size());
    const std::int64_t more = (g_mode == Mode::kFixed ? 2 : 10) * kMs;
    EXPECT(took >= least && took < all + more, "round %d took %lld ns on %zu cores", round,
           (long long)took, cores.size());
  }
  for (std::thread& thread : threads) thread.join();
}
