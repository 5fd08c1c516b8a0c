#include "tests/unit/scenario/scenario_folder.h"

#include <stdlib.h>

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <variant>

#include "coordinator/scenario/load.h"

namespace tcs {

namespace fs = std::filesystem;

const std::string_view kGoodScenario = R"(name: pursuit
duration: 20s
drift: 2ms
seed: 7
csv_period: 20ms
dynamics:
  integrator: verlet
  accuracy: 1e-4
  gravity: [0, 0, -9.81]
  region: {half_extent: 12, stiffness: 40, damping: 0.5}
bodies:
  predator:
    mass: 1.5
    inertia: [0.1, 0.2, 0.3]
    position: [-5, 0, 0]
  prey: {mass: 2, inertia: [1, 1, 1], linear_velocity: [1, 2, 3]}
robots:
  hunter:
    cpu: {cores: 4, speed: 0.5}
    clients:
      controller:
        command: [./controller, --seed, "${seed}"]
        class: periodic
        priority: 80
        body: predator
        environment: {MODE: fast}
        fixed_call_cost: 3us
      planner: {command: [sh, -c, "true"], patch_vdso: true, fixed_allocation_cost: 50ns}
channels:
  eyes:
    type: udp_json
    sensors: {bodies: [predator, prey], rate: 50, to: "127.0.0.1:47010", latency: 2ms}
  hands:
    type: udp_json
    commands: {body: prey, listen: "127.0.0.1:47011", latency: 3ms}
)";

ScenarioFolder::ScenarioFolder() {
  std::string name = (fs::temp_directory_path() / "tcs_scenario_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp failed");
  path_ = fs::canonical(name);
  Copy(TCS_DYNAMIC_PROGRAM, "controller");
}

ScenarioFolder::~ScenarioFolder() { fs::remove_all(path_); }

std::string ScenarioFolder::Write(std::string_view name, std::string_view text) const {
  std::ofstream(Path(name), std::ios::binary) << text;
  return Path(name);
}

std::string ScenarioFolder::WriteExecutable(std::string_view name, std::string_view text) const {
  Write(name, text);
  fs::permissions(Path(name), fs::perms(0755));
  return Path(name);
}

std::string ScenarioFolder::Copy(std::string_view program, std::string_view name) const {
  fs::copy_file(program, Path(name));
  return Path(name);
}

std::string ScenarioFolder::Patch(std::string_view name, std::size_t offset,
                                  std::string_view bytes) const {
  std::ifstream file(TCS_DYNAMIC_PROGRAM, std::ios::binary);
  std::string image{std::istreambuf_iterator<char>(file), {}};
  return WriteExecutable(name, image.replace(offset, bytes.size(), bytes));
}

std::string WithReplaced(std::string_view from, std::string_view to) {
  std::string text(kGoodScenario);
  const std::size_t at = text.find(from);
  if (at == std::string::npos || text.find(from, at + 1) != std::string::npos) {
    throw std::logic_error("not once in the scenario: " + std::string(from));
  }
  return text.replace(at, from.size(), to);
}

std::string Complaint(const ScenarioFolder& folder, std::string_view text) {
  const auto result = LoadScenario(folder.Write("s.yaml", text));
  const auto* error = std::get_if<LoadError>(&result);
  if (error == nullptr) return "";
  const std::string prefix = folder.path() + "/";
  return error->message.starts_with(prefix) ? error->message.substr(prefix.size())
                                            : "not in the file: " + error->message;
}

}  // namespace tcs
