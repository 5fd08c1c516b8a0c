#include "tests/bench/probe/work.h"

#include <time.h>

namespace tcs::bench {

namespace {

double Now() {
  timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

}  // namespace

double SecondsOfWork(std::int64_t steps) {
  const double start = Now();
  std::uint64_t state = 1;
  for (std::int64_t i = 0; i < steps; ++i) {
    state = state * 6364136223846793005u + 1442695040888963407u;
  }
  // The compiler must believe that somebody wants the result.
  __asm__ volatile("" : : "r"(state));
  return Now() - start;
}

}  // namespace tcs::bench
