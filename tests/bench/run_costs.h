// What whole runs cost: how much faster than real time they are, and where the time goes, for each
// of the events that they are about (a sample, a tick of a loop).
#pragma once

#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "tests/bench/spread.h"

namespace tcs::bench {

// Of one run. Microseconds are of processors, for each event.
struct RunCosts {
  double speed = 0;  // virtual time to real time
  double real_us = 0, programs_us = 0, world_us = 0, coordinating_us = 0;
  double dispatches = 0;  // for each event

  // From the summary.json of a run in which `events` happened.
  static RunCosts Of(const nlohmann::json& summary, double events);
};

// Of several runs of the same.
struct CostsSpread {
  Spread speed;
  // Medians.
  double real_us = 0, programs_us = 0, world_us = 0, coordinating_us = 0;
  double dispatches = 0;

  // Of at least one run.
  static CostsSpread Of(const std::vector<RunCosts>& runs);
};

// Runs each of `cases` once a round, so that all of them meet the same host. None if one of them
// could not be measured; `run` says why.
std::optional<std::vector<CostsSpread>> CostsInTurns(
    std::size_t cases, int rounds, const std::function<std::optional<RunCosts>(std::size_t)>& run);

}  // namespace tcs::bench
