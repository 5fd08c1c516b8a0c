#include "tests/bench/zoo_rows.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <functional>

#include "tests/unit/fuzz/attempt.h"
#include "tests/unit/models/model_folder.h"
#include "tests/zoo/dart_difference.h"
#include "tests/zoo/exercise.h"
#include "tests/zoo/robots.h"

namespace tcs::bench {
namespace {

// Each in a process of its own: what is measured is to go on.
std::optional<double> Measured(const std::function<double()>& measure) {
  constexpr unsigned kMostS = 60;
  const std::string said =
      fuzz::Outcome([&measure] { return fmt::format("={}", measure()); }, kMostS);
  if (!said.starts_with("=")) return std::nullopt;
  const double value = strtod(said.c_str() + 1, nullptr);
  return value < 0 ? std::nullopt : std::optional(value);
}

std::optional<double> Slowest(const WorldSpec& world, EngineKind engine, bool quick) {
  if (!zoo::HasRobots(TraitsOf(engine))) return std::nullopt;
  const VirtualDuration duration = VirtualDuration::Milliseconds(quick ? 20 : 1000);
  return Measured([&] {
    double slowest = 1e9;
    for (const zoo::Manner manner : zoo::kManners) {
      const zoo::Exercise done = zoo::Perform(world, engine, manner, duration);
      if (!done.wrong.empty()) return -1.0;
      slowest = std::min(slowest, duration.seconds() / std::max(1e-9, done.cpu_s));
    }
    return slowest;
  });
}

}  // namespace

std::vector<ZooRow> MeasureZoo(bool quick) {
  const ModelFolder folder;
  std::vector<ZooRow> rows;
  for (const zoo::Robot& robot : zoo::All()) {
    const std::filesystem::path scenario = zoo::WriteScenario(folder.Path(""), robot);
    const zoo::LoadedRobot loaded = zoo::LoadRobot(scenario);
    ZooRow& row = rows.emplace_back();
    row.robot = robot.name;
    row.load_ms = 1e3 * loaded.load_s;
    if (!loaded.mistake.empty()) continue;
    row.simbody = Slowest(loaded.world, EngineKind::kSimbody, quick);
    row.mujoco = Slowest(loaded.world, EngineKind::kMujoco, quick);
    if (quick) continue;
    row.from_dart = Measured([&] {
      return zoo::DifferenceToDart(zoo::UrdfOf(folder.Path(""), robot).string(),
                                   folder.Path("clone"), loaded.world.models.front())
          .value_or(-1);
    });
  }
  return rows;
}

}  // namespace tcs::bench
