// What a dispatch costs where few or many clients take turns, beside what the kernel alone needs to
// have as many processes do so.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "tests/bench/spread.h"

namespace tcs::bench {

inline constexpr std::array<int, 5> kCrowds{2, 8, 32, 96, 512};

struct DispatchRow {
  int clients = 0;
  double bare_us = 0;          // for each turn; a median, as the next
  double tcs_us = 0;           // of real time for each dispatch, without what clients compute
  Spread ratio;                // of the two
  double coordinating_us = 0;  // of that, the coordinator's own; a median
};

struct DispatchRows {
  int rounds = 0;
  std::vector<DispatchRow> rows;
};

// None, with a sentence on stderr, if one of them could not be measured.
std::optional<DispatchRows> MeasureDispatches(int rounds, bool quick);

}  // namespace tcs::bench
