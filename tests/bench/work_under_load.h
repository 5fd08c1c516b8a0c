// Does a program that computes find more time gone when others use the host? Natively and under
// libfaketime it does; under tcs it must not.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/probe_run.h"
#include "tests/bench/spread.h"

namespace tcs::bench {

inline constexpr std::array kSpinnerCounts{0, 2, 4};

struct WorkRow {
  World world = World::kNative;
  std::string title;
  double idle_seconds = 0;                               // by the program's own clock, median
  std::array<Spread, kSpinnerCounts.size()> relative{};  // to the same round's idle value
};

std::optional<std::vector<WorkRow>> MeasureWorkUnderLoad(int rounds, double seconds);

}  // namespace tcs::bench
