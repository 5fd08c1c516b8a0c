// Worlds of many robots: how much faster than real time a run of them is, and where its time goes.
// Each robot has a body and one program that commands it once a sample, by JSON over UDP.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "tests/bench/spread.h"

namespace tcs::bench {

struct FleetCase {
  int robots;
  int rate_hz;  // of each one's sensor, and so of its program
  double goal;  // times real time
};

inline constexpr std::array<FleetCase, 4> kFleets{
    {{1, 100, 40}, {1, 250, 0}, {8, 250, 0}, {30, 250, 1}}};

struct FleetRow {
  FleetCase fleet;
  Spread speed;  // virtual time to real time
  // Of the processor, for each sample and the command that answers it; medians. What is left of the
  // real time is switching between programs, and waiting for the host.
  double real_us = 0, programs_us = 0, world_us = 0, coordinating_us = 0;
  double dispatches = 0;  // for each sample
};

struct FleetRows {
  int rounds = 0;
  double virtual_s = 0;
  std::vector<FleetRow> rows;
};

// None, with a sentence on stderr, if one of them could not be measured.
std::optional<FleetRows> MeasureFleets(int rounds, bool quick);

}  // namespace tcs::bench
