// Does the same work again and again, and prints what it was charged for one piece: the median,
// the most, and what a quarter cost less than, in µs. A second line has the ten dearest pieces. A
// third one has all of them, as they came: when each began, in µs, and what it was charged.
//
//   steady_worker short COUNT  some 100 µs of it, then sleeps 0.1 ms
//   steady_worker long COUNT   some ms of it, without looking at a clock
//
// SIGTERM ends it earlier, after the piece at which it is.
#include <signal.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace {

double Us(clockid_t clock) {
  timespec t;
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) * 1e6 + static_cast<double>(t.tv_nsec) * 1e-3;
}

volatile sig_atomic_t g_ends = 0;

void Work(int loops) {
  volatile int sum = 0;
  for (int i = 0; i < loops; ++i) sum = sum + i;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const bool is_short = strcmp(argv[1], "short") == 0;
  signal(SIGTERM, [](int) { g_ends = 1; });
  fprintf(stderr, "%d\n", getpid());
  std::vector<double> charged, begun;
  for (int i = atoi(argv[2]); i > 0 && g_ends == 0; --i) {
    begun.push_back(Us(CLOCK_MONOTONIC));
    const double before = Us(CLOCK_THREAD_CPUTIME_ID);
    Work(is_short ? 300'000 : 10'000'000);
    charged.push_back(Us(CLOCK_THREAD_CPUTIME_ID) - before);
    if (is_short) usleep(100);
  }
  const std::vector<double> pieces = charged;
  std::sort(charged.begin(), charged.end());
  printf("%.0f %.0f %.0f\n", charged[charged.size() / 2], charged.back(),
         charged[charged.size() / 4]);
  for (std::size_t i = 1; i <= std::min<std::size_t>(10, charged.size()); ++i) {
    printf("%.0f ", charged[charged.size() - i]);
  }
  putchar('\n');
  for (std::size_t i = 0; i < pieces.size(); ++i) printf("%.0f %.1f ", begun[i], pieces[i]);
  putchar('\n');
  return 0;
}
