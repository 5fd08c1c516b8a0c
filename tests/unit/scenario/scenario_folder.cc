#include "tests/unit/scenario/scenario_folder.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>
#include <variant>

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
      planner: {command: [sh, -c, "true"], patch_vdso: false, rdtsc: host, fixed_allocation_cost: 50ns}
channels:
  eyes:
    type: udp_json
    sensors: {bodies: [predator, prey], rate: 50, to: "127.0.0.1:47010", latency: 2ms}
  hands:
    type: udp_json
    commands: {body: prey, listen: "127.0.0.1:47011", latency: 3ms}
)";

const std::string_view kGoodDdsScenario = R"(name: pursuit
duration: 20s
dynamics: {}
bodies:
  predator: {mass: 1, inertia: [1, 1, 1]}
  prey: {mass: 1, inertia: [1, 1, 1]}
robots:
  hunter:
    clients:
      controller: {command: [./controller], dds: sockets}
      planner: {command: [./controller], dds: endpoints}
      other: {command: [./controller]}
clock: {topic: /sim/clock, rate: 50, domain: 7}
channels:
  odometry:
    type: dds
    sensors:
      bodies: [prey]
      message: nav_msgs/msg/Odometry
      topic: /odom
      rate: 200
      latency: 2ms
      domain: 3
      qos: {reliability: best_effort, history: keep_last, depth: 5, durability: transient_local,
            deadline: 20ms, lifespan: 1s, lease: 3s}
  joints:
    type: dds
    sensors: {bodies: [predator, prey], message: sensor_msgs/JointState, topic: /joint_states}
  thrust:
    type: dds
    commands:
      body: prey
      message: geometry_msgs/msg/Wrench
      topic: /cmd
      latency: 3ms
      domain: 3
      qos: {reliability: reliable, history: keep_all, deadline: 1s}
  push:
    type: dds
    commands: {body: predator, message: geometry_msgs/Wrench, topic: /push}
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

std::string WithReplaced(std::string_view from, std::string_view to, std::string_view in) {
  std::string text(in);
  const std::size_t at = text.find(from);
  if (at == std::string::npos || text.find(from, at + 1) != std::string::npos) {
    throw std::logic_error("not once in the scenario: " + std::string(from));
  }
  return text.replace(at, from.size(), to);
}

Scenario ScenarioOf(LoadResult<Scenario> result) {
  if (const auto* error = std::get_if<LoadError>(&result)) {
    ADD_FAILURE() << error->message;
    return {};
  }
  return std::get<Scenario>(std::move(result));
}

std::string Complaint(const ScenarioFolder& folder, const LoadResult<Scenario>& result) {
  const auto* error = std::get_if<LoadError>(&result);
  if (error == nullptr) return "";
  EXPECT_EQ(error->message.find('\n'), std::string::npos) << error->message;
  const std::string prefix = folder.path() + "/";
  return error->message.starts_with(prefix) ? error->message.substr(prefix.size()) : error->message;
}

std::string Complaint(const ScenarioFolder& folder, std::string_view text) {
  const std::string complaint = Complaint(folder, LoadScenario(folder.Write("s.yaml", text)));
  const bool is_in_the_file = complaint.empty() || complaint.starts_with("s.yaml");
  return is_in_the_file ? complaint : "not in the file: " + complaint;
}

}  // namespace tcs
