// What the DDS programs of the tests have in common.
#pragma once

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include <cstdint>

#include "dds/dds.h"

inline dds_return_t OrDie(dds_return_t result, const char* what) {
  if (result >= 0) return result;
  fprintf(stderr, "cannot %s: %s\n", what, dds_strretcode(result));
  exit(1);
}

// In nanoseconds.
inline std::int64_t Now(clockid_t id = CLOCK_MONOTONIC) {
  timespec t;
  clock_gettime(id, &t);
  return t.tv_sec * 1'000'000'000ll + t.tv_nsec;
}

// For so long by the thread's own CPU clock.
inline void Compute(std::int64_t ns) {
  const std::int64_t end = Now(CLOCK_THREAD_CPUTIME_ID) + ns;
  while (Now(CLOCK_THREAD_CPUTIME_ID) < end) {
  }
}
