// parallel_regions THREADS US: 200 parallel regions of OpenMP, in each of which each thread
// computes for so long by its own CPU clock; three times. Prints how long a region took, in us, the
// shortest of the three. The library's barriers spin before they sleep.
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace {

double Us(clockid_t clock) {
  timespec now;
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) * 1e6 + static_cast<double>(now.tv_nsec) / 1e3;
}

}  // namespace

int main(int, char** argv) {
  constexpr int kRegions = 200;
  const int threads = atoi(argv[1]);
  const double work_us = atof(argv[2]);
  double least_us = 1e9;
  for (int round = 0; round < 3; ++round) {
    const double begun_us = Us(CLOCK_MONOTONIC);
    for (int i = 0; i < kRegions; ++i) {
#pragma omp parallel num_threads(threads)
      {
        const double until_us = Us(CLOCK_THREAD_CPUTIME_ID) + work_us;
        while (Us(CLOCK_THREAD_CPUTIME_ID) < until_us) {
        }
      }
    }
    least_us = std::min(least_us, (Us(CLOCK_MONOTONIC) - begun_us) / kRegions);
  }
  printf("%.2f\n", least_us);
}
