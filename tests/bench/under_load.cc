#include "tests/bench/under_load.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>

#include "tests/bench/spinners.h"

namespace tcs::bench {

namespace {

constexpr std::int64_t kTrialSteps = 20'000'000;

struct Samples {
  LoadRow row;
  std::array<std::vector<double>, kSpinnerCounts.size()> numbers;
};

// How many steps take `seconds` natively.
std::optional<std::string> StepsFor(double seconds) {
  const auto trial = RunProbe({"work", World::kNative, std::to_string(kTrialSteps)});
  if (!trial) return std::nullopt;
  return std::to_string(
      static_cast<std::int64_t>(static_cast<double>(kTrialSteps) * seconds / *trial));
}

// One run in each world beside the given number of spinners.
bool MeasureBeside(std::size_t load, Probe probe, std::vector<Samples>* all) {
  const Spinners spinners(kSpinnerCounts[load]);
  if (!spinners.complete()) {
    fmt::print(stderr, "tcs_bench: {}: the spinners cannot be started\n", probe.what);
    return false;
  }
  for (Samples& samples : *all) {
    probe.world = samples.row.world;
    const auto number = RunProbe(probe);
    if (!number) return false;
    samples.numbers[load].push_back(*number);
  }
  return true;
}

LoadRow Summarize(const Samples& samples) {
  LoadRow row = samples.row;
  const std::vector<double>& idle = samples.numbers[0];
  row.idle = SpreadOf(idle).median;
  for (std::size_t load = 0; load < kSpinnerCounts.size(); ++load) {
    std::vector<double> relative;
    for (std::size_t round = 0; round < idle.size(); ++round) {
      relative.push_back(samples.numbers[load][round] / idle[round]);
    }
    row.relative[load] = SpreadOf(relative);
  }
  return row;
}

std::optional<std::vector<LoadRow>> MeasureUnderLoad(const Probe& probe, int rounds) {
  std::vector<Samples> all{{{World::kNative, "natively"}, {}},
                           {{World::kFaketime, "under libfaketime"}, {}},
                           {{World::kTcs, "under tcs"}, {}}};
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t load = 0; load < kSpinnerCounts.size(); ++load) {
      if (!MeasureBeside(load, probe, &all)) return std::nullopt;
    }
  }
  std::vector<LoadRow> rows;
  for (const Samples& samples : all) rows.push_back(Summarize(samples));
  return rows;
}

}  // namespace

std::optional<std::vector<LoadRow>> MeasureWorkUnderLoad(int rounds, double seconds) {
  const std::optional<std::string> steps = StepsFor(seconds);
  if (!steps) return std::nullopt;
  return MeasureUnderLoad({"work", World::kNative, *steps}, rounds);
}

std::optional<std::vector<LoadRow>> MeasurePlanningUnderLoad(int rounds, double seconds) {
  return MeasureUnderLoad({"explored", World::kNative, fmt::format("{}", seconds)}, rounds);
}

}  // namespace tcs::bench
