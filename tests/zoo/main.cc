// tcs_zoo quick|all|NAME...|FILE.urdf...: loads each robot of the zoo, or of a file, as people do,
// at the first try and with no variable set, and lets it be free, held and moved on both engines. 0
// if that went well. Prints how many times faster than real time that was, on one processor, and
// with how many steps of the engine a second: reported, and not judged. Robots of files have a
// fixed base, and no floor; of these it prints how far their joints are from where DART has them
// after 1 s of smooth motion, too.
#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "simbody_bridge/engines.h"
#include "tests/unit/fuzz/attempt.h"
#include "tests/unit/models/model_folder.h"
#include "tests/zoo/dart_difference.h"
#include "tests/zoo/exercise.h"
#include "tests/zoo/robots.h"

namespace tcs::zoo {
namespace {

constexpr unsigned kMostS = 60;  // of a processor, for what runs 5 s
constexpr VirtualDuration kWhole = VirtualDuration::Seconds(5);
constexpr VirtualDuration kQuick = VirtualDuration::Milliseconds(200);

bool IsSentence(const std::string& warning) {
  return !warning.empty() && warning.find('\n') == std::string::npos;
}

struct Tried {
  int wrong = 0, slow = 0;
};

// The figure, or what is wrong.
std::string Try(const WorldSpec& world, EngineKind engine, Manner manner, VirtualDuration duration,
                Tried* tried) {
  const std::string said = fuzz::Outcome(
      [&] {
        const Exercise done = Perform(world, engine, manner, duration);
        return done.wrong.empty() ? fmt::format("={} {}", done.cpu_s, done.steps) : done.wrong;
      },
      kMostS);
  if (!said.starts_with("=")) {
    ++tried->wrong;
    return fmt::format("{}: {}", NameOf(manner), said);
  }
  char* end = nullptr;
  const double times = duration.seconds() / std::max(1e-9, strtod(said.c_str() + 1, &end));
  if (times < 1) ++tried->slow;
  return fmt::format("{:.3g} ({:.2g})", times, strtod(end, nullptr) / duration.seconds());
}

// The folder of the package that the file belongs to, or its own.
std::filesystem::path PackageOf(const std::filesystem::path& urdf) {
  std::filesystem::path folder = urdf.parent_path();
  while (folder.has_relative_path() && !exists(folder / "package.xml")) {
    folder = folder.parent_path();
  }
  return folder.has_relative_path() ? folder : urdf.parent_path();
}

// The packages that the file names are beside its own.
std::string BesideDart(const std::filesystem::path& urdf, const RobotModel& model) {
  const std::filesystem::path packages = PackageOf(urdf).parent_path();
  const std::string said = fuzz::Outcome(
      [&] {
        const std::optional<double> off = DifferenceToDart(urdf.string(), packages.string(), model);
        return off ? fmt::format("={:.2g}", *off) : "cannot say";
      },
      kMostS);
  return "  DART " + (said.starts_with("=") ? said.substr(1) : said);
}

struct Candidate {
  std::string name;
  std::filesystem::path scenario;
  std::filesystem::path urdf;  // empty: one of the zoo
};

std::vector<Candidate> CandidatesOf(const std::vector<std::string_view>& names, bool is_all,
                                    const ModelFolder& folder) {
  std::vector<Candidate> candidates;
  for (const Robot& robot : All()) {
    if (!is_all && std::ranges::find(names, robot.name) == names.end()) continue;
    candidates.push_back({robot.name, WriteScenario(folder.Path(""), robot), {}});
  }
  for (const std::filesystem::path file : names) {
    if (file.extension() != ".urdf") continue;
    candidates.push_back(
        {file.stem().string(),
         WriteScenarioOf(folder.Path("of" + std::to_string(candidates.size())), file), file});
  }
  return candidates;
}

int Run(const std::vector<std::string_view>& names) {
  for (const char* variable : {"ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH"}) unsetenv(variable);
  const bool is_quick = names.front() == "quick";
  const bool is_all = is_quick || names.front() == "all";
  const ModelFolder folder;
  Tried tried;
  int robots = 0, cases = 0;
  for (const auto& [name, scenario, urdf] : CandidatesOf(names, is_all, folder)) {
    const LoadedRobot loaded = LoadRobot(scenario);
    std::string line = fmt::format("{:16}", name);
    if (!loaded.mistake.empty()) {
      ++tried.wrong;
      fmt::print("{} is refused: {}\n", line, loaded.mistake);
      continue;
    }
    for (const std::string& warning : loaded.warnings) {
      if (!is_all) fmt::print("  {}\n", warning);
      if (!IsSentence(warning)) ++tried.wrong;
    }
    line += fmt::format(" {:4.0f} ms", 1e3 * loaded.load_s);
    for (const EngineTraits& engine : kEngines) {
      if (!HasRobots(engine)) continue;
      line += fmt::format("  {}", engine.name);
      for (std::size_t i = 0; i < kManners.size(); ++i) {
        // In a hurry each robot does one thing.
        if (is_quick && i != static_cast<std::size_t>(robots) % kManners.size()) continue;
        line +=
            " " + Try(loaded.world, engine.kind, kManners[i], is_quick ? kQuick : kWhole, &tried);
        ++cases;
      }
    }
    if (!urdf.empty()) line += BesideDart(absolute(urdf), loaded.world.models.front());
    ++robots;
    fmt::print("{}\n", line);
    std::fflush(stdout);
  }
  fmt::print("{} robots, {} exercises, {} wrong, {} slower than real time\n", robots, cases,
             tried.wrong, tried.slow);
  return robots > 0 && tried.wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace tcs::zoo

int main(int argc, char** argv) {
  const std::vector<std::string_view> names(argv + 1, argv + argc);
  if (names.empty()) {
    fmt::print(stderr, "usage: tcs_zoo quick|all|NAME...|FILE.urdf...\n");
    return 2;
  }
  return tcs::zoo::Run(names);
}
