// Timing of something so short that only many calls of it can be timed.
#pragma once

#include <x86gprintrin.h>

#include <cstdint>
#include <vector>

#include "tests/bench/spread.h"

namespace tcs::bench {

struct BatchSize {
  int batches;
  int calls;  // in each batch
};

// TSC ticks per call: real time, under tcs too. The median over the batches, so that batches in
// which the host took the processor away do not count.
template <class Call>
double TicksPerCall(BatchSize size, Call call) {
  std::vector<double> per_call;
  for (int batch = 0; batch < size.batches; ++batch) {
    const std::uint64_t start = __rdtsc();
    for (int i = 0; i < size.calls; ++i) call();
    per_call.push_back(static_cast<double>(__rdtsc() - start) / size.calls);
  }
  return SpreadOf(per_call).median;
}

}  // namespace tcs::bench
