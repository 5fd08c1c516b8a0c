// Worlds of many robots: how much faster than real time a run of them is, and where its time goes.
// Each robot has a body and one program that commands it once a sample, by JSON over UDP.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "tests/bench/run_costs.h"

namespace tcs::bench {

struct FleetCase {
  int robots = 1;
  int rate_hz = 100;    // of each one's sensor
  bool answers = true;  // its program, to each sample; else it sleeps
  double goal = 0;      // times real time; 0: none
};

// A sample at 1 kHz of a body that nothing happens to is to take 50 µs: 20 times real time.
inline constexpr std::array<FleetCase, 5> kFleets{{{.rate_hz = 1000, .answers = false, .goal = 20},
                                                   {.rate_hz = 100, .goal = 40},
                                                   {.rate_hz = 250},
                                                   {.robots = 8, .rate_hz = 250},
                                                   {.robots = 30, .rate_hz = 250, .goal = 1}}};

struct FleetRow {
  FleetCase fleet;
  // For each sample and the command that answers it. What is left of the real time is switching
  // between programs, and waiting for the host.
  CostsSpread costs;
};

struct FleetRows {
  int rounds = 0;
  double virtual_s = 0;
  std::vector<FleetRow> rows;
};

// None, with a sentence on stderr, if one of them could not be measured.
std::optional<FleetRows> MeasureFleets(int rounds, bool quick);

}  // namespace tcs::bench
