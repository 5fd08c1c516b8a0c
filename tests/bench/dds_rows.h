// What it is worth to programs that speak DDS, and what it costs the host, that samples go through
// shared memory: ddsperf under tcs beside ddsperf over the kernel's loopback, in turns.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/spread.h"

namespace tcs::bench {

inline constexpr std::array kCarrierNames{"native", "sockets", "endpoints"};

struct DdsRow {
  std::string size, what, unit;
  bool more_is_better = false;
  std::array<double, kCarrierNames.size()> value{};  // medians of the rounds
  Spread ratio;                                      // endpoints to native, of one round's values
};

struct DdsRows {
  int rounds = 0;
  unsigned processors = 0;                        // that the native runs had
  std::vector<DdsRow> own_clocks, real_s, cpu_s;  // the host's seconds for 100,000 of them
};

// `gently`: few samples, which shows only that all can be measured.
std::optional<DdsRows> MeasureDds(int rounds, bool gently);

}  // namespace tcs::bench
