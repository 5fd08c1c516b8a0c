// What robots with joints and rotors cost: their physics beside the bare engines', and whole swarms
// of quadrotors with four programs each.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/run_costs.h"
#include "tests/bench/spread.h"
#include "tests/bench/zoo_rows.h"

namespace tcs::bench {

struct ModelRow {
  std::string robot, engine;
  double goal = 0;        // times real time; 0: none
  Spread speed;           // virtual time to processor time
  double bare_speed = 0;  // the engine's own; a median
  Spread ratio;           // of the time that it takes to the bare engine's
};

struct SwarmCase {
  int drones = 1;
  int rate_hz = 1000;  // of their rate loops
  int host_cpus = 1;
  double goal = 0;  // times real time; 0: none
};

inline constexpr std::array<SwarmCase, 5> kSwarms{
    {{.drones = 1},
     {.drones = 10},
     {.drones = 10, .host_cpus = 2, .goal = 1},
     {.drones = 30, .rate_hz = 250},
     {.drones = 30, .rate_hz = 250, .host_cpus = 2, .goal = 1}}};

struct SwarmRow {
  SwarmCase swarm;
  CostsSpread costs;  // for each tick of a rate loop and what belongs to it
};

struct RobotRows {
  int rounds = 0;
  double virtual_s = 0;  // of a swarm
  std::vector<ModelRow> models;
  std::vector<SwarmRow> swarms;
  std::vector<ZooRow> zoo;
};

// None, with a sentence on stderr, if one of them could not be measured. Swarms are on MuJoCo,
// where there is one.
std::optional<RobotRows> MeasureRobots(int rounds, bool quick);

}  // namespace tcs::bench
