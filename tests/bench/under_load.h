// Does it matter to a program that computes what else the host does? Natively and under libfaketime
// it does; under tcs it must not.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/probe_run.h"
#include "tests/bench/spread.h"

namespace tcs::bench {

inline constexpr std::array kSpinnerCounts{0, 2, 4, 8};

struct LoadRow {
  World world = World::kNative;
  std::string title;
  double idle = 0;                                       // the probe's number, median
  std::array<Spread, kSpinnerCounts.size()> relative{};  // to the same round's idle value
};

// By the program's own clock, the seconds that fixed work of about `seconds` takes.
std::optional<std::vector<LoadRow>> MeasureWorkUnderLoad(int rounds, double seconds);

// The states that OMPL explores in so many seconds of the program's own clock.
std::optional<std::vector<LoadRow>> MeasurePlanningUnderLoad(int rounds, double seconds);

}  // namespace tcs::bench
