// computing_threads N SECONDS: N threads compute for SECONDS of processor time each. Prints how
// long that took, in seconds.
#include <time.h>

#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

namespace {

double Seconds(clockid_t clock) {
  timespec t;
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) * 1e-9;
}

void ComputeFor(double seconds) {
  const double start = Seconds(CLOCK_THREAD_CPUTIME_ID);
  volatile long work = 0;
  while (Seconds(CLOCK_THREAD_CPUTIME_ID) - start < seconds) {
    for (int i = 0; i < 10'000; ++i) work = work + 1;
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const double start = Seconds(CLOCK_MONOTONIC);
  std::vector<std::thread> threads;
  for (int i = 0; i < atoi(argv[1]); ++i) threads.emplace_back(ComputeFor, atof(argv[2]));
  for (std::thread& thread : threads) thread.join();
  printf("%.6f\n", Seconds(CLOCK_MONOTONIC) - start);
}
