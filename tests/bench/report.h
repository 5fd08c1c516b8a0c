// What tcs_bench prints: tables for people, or one JSON object.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/bench/call_ratios.h"
#include "tests/bench/dds_rows.h"
#include "tests/bench/dispatch_rows.h"
#include "tests/bench/fleet_rows.h"
#include "tests/bench/physics_rows.h"
#include "tests/bench/robot_rows.h"
#include "tests/bench/under_load.h"

namespace tcs::bench {

struct Results {
  int rounds = 0;
  std::vector<CallRow> calls;
  std::vector<LoadRow> work, planning;
  std::optional<DdsRows> dds;
  std::optional<PhysicsRows> physics;
  std::optional<FleetRows> fleets;
  std::optional<DispatchRows> dispatches;
  std::optional<RobotRows> robots;
};

std::string ToTables(const Results& results);
std::string ToJson(const Results& results);

}  // namespace tcs::bench
