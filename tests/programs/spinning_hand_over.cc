// spinning_hand_over HOW US: two threads hand over to each other 200 times each by a word in
// memory, and look at it again and again: with `pause`, by `yield`, with a pause and a look at the
// clock (`clock`), or with nothing in between
// (`bare`). Each computes for so long, by its CPU clock, before it hands over. Prints how long one
// hand-over took, in us, and how much processor time both have been charged of the time that has
// passed.
#include <immintrin.h>
#include <pthread.h>
#include <sched.h>
#include <time.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

constexpr int kTimes = 200;

std::atomic<int> g_turn;
std::string g_how;
double g_work_us;

double Us(clockid_t clock) {
  timespec now;
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) * 1e6 + static_cast<double>(now.tv_nsec) / 1e3;
}

// Its own function: tcs has room there for its jump, and else would not know of it.
[[gnu::noinline]] void Pause() { _mm_pause(); }

template <class Look>
void TakeTurns(int own, Look look) {
  for (int i = 0; i < kTimes; ++i) {
    while (g_turn.load(std::memory_order_acquire) != own) look();
    const double until_us = Us(CLOCK_THREAD_CPUTIME_ID) + g_work_us;
    while (Us(CLOCK_THREAD_CPUTIME_ID) < until_us) {
    }
    g_turn.store(1 - own, std::memory_order_release);
  }
}

void Run(int own) {
  if (g_how == "pause") return TakeTurns(own, Pause);
  if (g_how == "yield") return TakeTurns(own, [] { sched_yield(); });
  if (g_how == "bare") return TakeTurns(own, [] {});
  TakeTurns(own, [] {
    Us(CLOCK_MONOTONIC);
    Pause();
  });
}

}  // namespace

int main(int, char** argv) {
  g_how = argv[1];
  g_work_us = atof(argv[2]);
  const double begun_us = Us(CLOCK_MONOTONIC);
  pthread_t other;
  pthread_create(
      &other, nullptr,
      [](void*) -> void* {
        Run(1);
        return nullptr;
      },
      nullptr);
  Run(0);
  pthread_join(other, nullptr);
  const double passed_us = Us(CLOCK_MONOTONIC) - begun_us;
  printf("%.2f %.2f\n", passed_us / (2 * kTimes), Us(CLOCK_PROCESS_CPUTIME_ID) / passed_us);
}
