// How dear a call under tcs is, as a multiple of a reference that is measured in turns with it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/bench/probe_run.h"
#include "tests/bench/spread.h"

namespace tcs::bench {

struct CallBenchmark {
  std::string name;  // for --only
  std::string title, reference_title;
  Probe probe, reference;
  std::string goal;
};

struct CallRow {
  CallBenchmark benchmark;
  double ns = 0, reference_ns = 0;  // medians
  Spread ratio;                     // of one round's two values
};

const std::vector<CallBenchmark>& CallBenchmarks();

std::optional<CallRow> MeasureCall(const CallBenchmark& benchmark, int rounds, double ns_per_tick);

}  // namespace tcs::bench
