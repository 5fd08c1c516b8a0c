#include "tests/bench/work_under_load.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>

#include "tests/bench/spinners.h"

namespace tcs::bench {

namespace {

constexpr std::int64_t kTrialSteps = 20'000'000;

struct Samples {
  WorkRow row;
  std::array<std::vector<double>, kSpinnerCounts.size()> seconds;
};

// How many steps take `seconds` natively.
std::optional<std::string> StepsFor(double seconds) {
  const auto trial = RunProbe({"work", World::kNative, std::to_string(kTrialSteps)});
  if (!trial) return std::nullopt;
  return std::to_string(
      static_cast<std::int64_t>(static_cast<double>(kTrialSteps) * seconds / *trial));
}

// One run in each world beside the given number of spinners.
bool MeasureBeside(std::size_t load, const std::string& steps, std::vector<Samples>* all) {
  const Spinners spinners(kSpinnerCounts[load]);
  if (!spinners.complete()) {
    fmt::print(stderr, "tcs_bench: work: the spinners cannot be started\n");
    return false;
  }
  for (Samples& samples : *all) {
    const auto seconds = RunProbe({"work", samples.row.world, steps});
    if (!seconds) return false;
    samples.seconds[load].push_back(*seconds);
  }
  return true;
}

WorkRow Summarize(const Samples& samples) {
  WorkRow row = samples.row;
  const std::vector<double>& idle = samples.seconds[0];
  row.idle_seconds = SpreadOf(idle).median;
  for (std::size_t load = 0; load < kSpinnerCounts.size(); ++load) {
    std::vector<double> relative;
    for (std::size_t round = 0; round < idle.size(); ++round) {
      relative.push_back(samples.seconds[load][round] / idle[round]);
    }
    row.relative[load] = SpreadOf(relative);
  }
  return row;
}

}  // namespace

std::optional<std::vector<WorkRow>> MeasureWorkUnderLoad(int rounds, double seconds) {
  const std::optional<std::string> steps = StepsFor(seconds);
  if (!steps) return std::nullopt;
  std::vector<Samples> all{{{World::kNative, "natively"}, {}},
                           {{World::kFaketime, "under libfaketime"}, {}},
                           {{World::kTcs, "under tcs"}, {}}};
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t load = 0; load < kSpinnerCounts.size(); ++load) {
      if (!MeasureBeside(load, *steps, &all)) return std::nullopt;
    }
  }
  std::vector<WorkRow> rows;
  for (const Samples& samples : all) rows.push_back(Summarize(samples));
  return rows;
}

}  // namespace tcs::bench
