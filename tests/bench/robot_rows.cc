#include "tests/bench/robot_rows.h"

#include <fmt/format.h>

#include <cstdio>
#include <utility>

#include "tests/bench/child.h"
#include "tests/bench/host.h"
#include "tests/bench/model_work.h"
#include "tests/bench/tcsim_run.h"

namespace tcs::bench {

namespace {

struct ModelCase {
  const char* robot;
  std::optional<ModelWork> (*work)(bool quick);
  EngineKind engine;
  const char* engine_name;
  double (*bare)(const ModelWork& work);
  double goal;
};

constexpr ModelCase kModels[] = {
    {"quadrotor, 1 kHz", &QuadrotorWork, EngineKind::kSimbody, "Simbody", &BareSimbodySeconds, 5},
    {"quadrotor, 1 kHz", &QuadrotorWork, EngineKind::kMujoco, "MuJoCo", &BareMujocoSeconds, 50},
    {"arm, 100 Hz", &ArmWork, EngineKind::kSimbody, "Simbody", &BareSimbodySeconds, 20},
    {"arm, 100 Hz", &ArmWork, EngineKind::kMujoco, "MuJoCo", &BareMujocoSeconds, 20}};

std::optional<ModelRow> MeasureModel(const ModelCase& of, int rounds, bool quick) {
  const auto work = of.work(quick);
  if (!work) return std::nullopt;
  std::vector<double> speed, bare_speed, ratio;
  for (int round = 0; round < rounds; ++round) {
    const double bare_s = of.bare(*work), ours_s = DynamicsSeconds(*work, of.engine);
    bare_speed.push_back(work->seconds() / bare_s);
    speed.push_back(work->seconds() / ours_s);
    ratio.push_back(ours_s / bare_s);
  }
  return ModelRow{
      of.robot,       of.engine_name, of.goal, SpreadOf(speed), SpreadOf(bare_speed).median,
      SpreadOf(ratio)};
}

void ReplaceAll(std::string* text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text->find(from, at)) != std::string::npos; at += to.size()) {
    text->replace(at, from.size(), to);
  }
}

// Of examples/quadrotor. The programs and the model are where they were built.
std::optional<std::string> ScenarioOf(const SwarmCase& swarm) {
  const std::string folder = std::string(TCS_EXAMPLES) + "/quadrotor";
  ChildResult printed = RunChild(
      {folder + "/swarm.py", std::to_string(swarm.drones), "--hz", std::to_string(swarm.rate_hz)});
  if (!printed.error.empty()) {
    fmt::print(stderr, "tcs_bench: robots: {}\n", printed.error);
    return std::nullopt;
  }
  ReplaceAll(&printed.output, "[./", "[" + folder + "/");
  ReplaceAll(&printed.output, "urdf: ", "urdf: " + folder + "/");
  return printed.output;
}

std::optional<RunCosts> RunOnce(const SwarmCase& swarm, double virtual_s) {
  const auto scenario = ScenarioOf(swarm);
  if (!scenario) return std::nullopt;
  const OnAllCpus all;
  const auto run = TcsimRun::Of("robots", *scenario,
                                {"--set", fmt::format("duration={}s", virtual_s), "--host-cpus",
                                 std::to_string(swarm.host_cpus)});
  if (!run) return std::nullopt;
  const auto commands = run->summary().at("commands").get<double>();
  const double ticks = swarm.drones * swarm.rate_hz * virtual_s;
  // Each tick of a rate loop sends a command; the first ones come before the programs have begun,
  // which takes a slow host long.
  if (commands < 0.2 * ticks) {
    fmt::print(stderr, "tcs_bench: robots: {} commands in {} ticks\n", commands, ticks);
    return std::nullopt;
  }
  return RunCosts::Of(run->summary(), ticks);
}

}  // namespace

std::optional<RobotRows> MeasureRobots(int rounds, bool quick) {
  RobotRows results{.rounds = rounds,
                    .virtual_s = quick ? 0.2 : 4,
                    .models = {},
                    .swarms = {},
                    .zoo = MeasureZoo(quick)};
  for (const ModelCase& of : kModels) {
    if (of.engine == EngineKind::kMujoco && !HasMujoco()) continue;
    auto row = MeasureModel(of, rounds, quick);
    if (!row) return std::nullopt;
    results.models.push_back(std::move(*row));
  }
  auto asked = kSwarms;
  if (quick) {
    for (SwarmCase& swarm : asked) swarm.drones = (swarm.drones + 4) / 5;
  }
  const auto swarms = CostsInTurns(
      asked.size(), rounds, [&](std::size_t i) { return RunOnce(asked[i], results.virtual_s); });
  if (!swarms) return std::nullopt;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    results.swarms.push_back({asked[i], (*swarms)[i]});
  }
  return results;
}

}  // namespace tcs::bench
