// tcs_bench: what tcs costs, as ratios. Every value is measured in turns with its reference, so
// that a host that is slow today slows down both. It judges nothing: the exit status is 0 if
// everything asked for was measured, else 1.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/host.h"
#include "tests/bench/report.h"

namespace {

constexpr char kWork[] = "work";
constexpr char kPlanning[] = "planning";
constexpr char kDds[] = "dds";
constexpr char kPhysics[] = "physics";
constexpr char kFleet[] = "fleet";
constexpr char kDispatch[] = "dispatch";
constexpr char kRobots[] = "robots";
constexpr int kRounds = 7;
constexpr int kDdsRounds = 3;  // each of which takes a minute or two

bool Wanted(const std::vector<std::string>& only, const std::string& name) {
  return only.empty() || std::find(only.begin(), only.end(), name) != only.end();
}

}  // namespace

int main(int argc, char** argv) {
  std::optional<int> asked_rounds;
  std::vector<std::string> only;
  bool json = false, quick = false;
  std::vector<std::string> names{kWork, kPlanning, kDds, kPhysics, kFleet, kDispatch, kRobots};
  for (const auto& benchmark : tcs::bench::CallBenchmarks()) names.push_back(benchmark.name);

  CLI::App app{"Prints what tcs costs, as ratios to references measured in the same run"};
  app.add_option(
         "--rounds", asked_rounds,
         fmt::format(
             "whose medians are printed; {} unless told, of dds, fleet, dispatch and robots {}",
             kRounds, kDdsRounds))
      ->check(CLI::Range(1, 1000));
  app.add_option("--only", only, "these benchmarks alone")->check(CLI::IsMember(names));
  app.add_flag("--json", json, "print one JSON object instead of tables");
  app.add_flag("--quick", quick, "one round and little work: shows only that all can be measured");
  CLI11_PARSE(app, argc, argv);
  if (quick) asked_rounds = 1;
  const int rounds = asked_rounds.value_or(kRounds);
  const double work_seconds = quick ? 0.05 : 0.3, planning_seconds = quick ? 0.1 : 1;
  tcs::bench::Results results;
  results.rounds = rounds;
  bool complete = true;
  // First, while all CPUs may be used.
  if (Wanted(only, kDds)) {
    results.dds = tcs::bench::MeasureDds(asked_rounds.value_or(kDdsRounds), quick);
    complete = results.dds.has_value();
  }

  if (!tcs::bench::BindToLastCpu()) {
    fmt::print(stderr, "tcs_bench: cannot bind to a CPU\n");
    return 1;
  }
  const double ns_per_tick = tcs::bench::NsPerTick();
  for (const auto& benchmark : tcs::bench::CallBenchmarks()) {
    if (!Wanted(only, benchmark.name)) continue;
    auto row = tcs::bench::MeasureCall(benchmark, rounds, ns_per_tick);
    if (row) results.calls.push_back(*row);
    complete = complete && row.has_value();
  }
  if (Wanted(only, kWork)) {
    auto rows = tcs::bench::MeasureWorkUnderLoad(rounds, work_seconds);
    if (rows) results.work = *rows;
    complete = complete && rows.has_value();
  }
  if (Wanted(only, kPlanning)) {
    auto rows = tcs::bench::MeasurePlanningUnderLoad(rounds, planning_seconds);
    if (rows) results.planning = *rows;
    complete = complete && rows.has_value();
  }
  if (Wanted(only, kPhysics)) results.physics = tcs::bench::MeasurePhysics(rounds, quick);
  if (Wanted(only, kFleet)) {
    results.fleets = tcs::bench::MeasureFleets(asked_rounds.value_or(kDdsRounds), quick);
    complete = complete && results.fleets.has_value();
  }
  if (Wanted(only, kDispatch)) {
    results.dispatches = tcs::bench::MeasureDispatches(asked_rounds.value_or(kDdsRounds), quick);
    complete = complete && results.dispatches.has_value();
  }
  if (Wanted(only, kRobots)) {
    results.robots = tcs::bench::MeasureRobots(asked_rounds.value_or(kDdsRounds), quick);
    complete = complete && results.robots.has_value();
  }
  fmt::print("{}", json ? ToJson(results) : ToTables(results));
  return complete ? 0 : 1;
}
