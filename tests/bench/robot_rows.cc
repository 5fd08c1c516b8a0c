#include "tests/bench/robot_rows.h"

#include <fmt/format.h>

#include <cstdio>
#include <utility>

#include "tests/bench/attempt.h"
#include "tests/bench/child.h"
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

struct Numbers {
  double speed, real_us, programs_us, world_us, coordinating_us, dispatches;
};

std::optional<Numbers> RunOnce(const SwarmCase& swarm, double virtual_s) {
  const auto scenario = ScenarioOf(swarm);
  if (!scenario) return std::nullopt;
  const auto run = TcsimRun::Of("robots", *scenario,
                                {"--set", fmt::format("duration={}s", virtual_s), "--host-cpus",
                                 std::to_string(swarm.host_cpus)});
  if (!run) return std::nullopt;
  const auto number = [&run](const char* key) { return run->summary().at(key).get<double>(); };
  const double ticks = swarm.drones * swarm.rate_hz * virtual_s;
  // Each tick of a rate loop sends a command; the first ones come before the programs have begun.
  if (number("commands") < 0.5 * ticks) {
    fmt::print(stderr, "tcs_bench: robots: {} commands in {} ticks\n", number("commands"), ticks);
    return std::nullopt;
  }
  const auto each_us = [&](const char* key) { return number(key) / 1e3 / ticks; };
  return Numbers{number("virtual_ns") / number("real_ns"),
                 each_us("real_ns"),
                 each_us("clients_ns"),
                 each_us("dynamics_ns"),
                 each_us("coordinating_ns"),
                 number("dispatches") / ticks};
}

SwarmRow RowOf(const SwarmCase& swarm, const std::vector<Numbers>& rounds) {
  const auto spread = [&rounds](double Numbers::*number) {
    std::vector<double> values;
    for (const Numbers& round : rounds) values.push_back(round.*number);
    return SpreadOf(values);
  };
  return {.swarm = swarm,
          .speed = spread(&Numbers::speed),
          .real_us = spread(&Numbers::real_us).median,
          .programs_us = spread(&Numbers::programs_us).median,
          .world_us = spread(&Numbers::world_us).median,
          .coordinating_us = spread(&Numbers::coordinating_us).median,
          .dispatches = spread(&Numbers::dispatches).median};
}

}  // namespace

std::optional<RobotRows> MeasureRobots(int rounds, bool quick) {
  RobotRows results{.rounds = rounds, .virtual_s = quick ? 0.2 : 4, .models = {}, .swarms = {}};
  for (const ModelCase& of : kModels) {
    if (of.engine == EngineKind::kMujoco && !HasMujoco()) continue;
    auto row = MeasureModel(of, rounds, quick);
    if (!row) return std::nullopt;
    results.models.push_back(std::move(*row));
  }
  std::array<std::vector<Numbers>, kSwarms.size()> all;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < kSwarms.size(); ++i) {
      const auto got = Attempt([&] { return RunOnce(kSwarms[i], results.virtual_s); });
      if (!got) return std::nullopt;
      all[i].push_back(*got);
    }
  }
  for (std::size_t i = 0; i < kSwarms.size(); ++i) {
    results.swarms.push_back(RowOf(kSwarms[i], all[i]));
  }
  return results;
}

}  // namespace tcs::bench
