#include "tests/bench/model_work.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <utility>
#include <variant>

#include "coordinator/scenario/load.h"
#include "tests/bench/physics_world.h"

namespace tcs::bench {

namespace {

constexpr double kStandardGravityMps2 = 9.80665;

std::vector<double> Hover(int sample, const RobotModel& model) {
  double mass_kg = 0;
  for (const Link& link : model.links) mass_kg += link.inertial ? link.inertial->mass_kg : 0;
  const auto rotors = static_cast<double>(model.rotors.size());
  const double speed =
      std::sqrt(mass_kg * kStandardGravityMps2 / rotors / model.rotors.front().thrust_ns2);
  return std::vector<double>(model.rotors.size(), speed * (1 + 0.01 * (sample % 5 - 2)));
}

// Around where it starts. Half a radian off a servo gives all that its joint can.
std::vector<JointDrive> Wave(int sample, const RobotModel& model) {
  std::vector<JointDrive> drives;
  for (const Joint& joint : model.joints) {
    if (joint.kind == JointKind::kFixed) continue;
    const double start = joint.initial_position.empty() ? 0 : joint.initial_position.front();
    drives.push_back({.stiffness = 2 * joint.limits.effort,
                      .position = start + 0.2 * std::sin(0.02 * sample),
                      .damping = 0.1 * joint.limits.effort});
  }
  return drives;
}

std::optional<ModelWork> Load(const std::string& example, std::vector<std::string> set) {
  const std::string path = std::string(TCS_EXAMPLES) + "/" + example + "/scenario.yaml";
  auto loaded = LoadScenario(path, {.set = std::move(set)});
  if (const auto* error = std::get_if<LoadError>(&loaded)) {
    fmt::print(stderr, "tcs_bench: robots: {}\n", error->message);
    return std::nullopt;
  }
  ModelWork work;
  work.world = std::move(*std::get<Scenario>(loaded).world);
  return work;
}

}  // namespace

std::optional<ModelWork> QuadrotorWork(bool quick) {
  auto work = Load("quadrotor", {"models.drone.at.position=[0, 0, 2]"});
  if (!work) return std::nullopt;
  work->period = VirtualDuration::Milliseconds(1);
  work->answers_after = VirtualDuration::Microseconds(50);
  work->samples = quick ? 20 : 3000;
  work->speeds_radps = &Hover;
  return work;
}

std::optional<ModelWork> ArmWork(bool quick) {
  auto work = Load("arm", {});
  if (!work) return std::nullopt;
  work->period = VirtualDuration::Milliseconds(10);
  work->answers_after = VirtualDuration::Microseconds(500);
  work->samples = quick ? 5 : 500;
  work->drives = &Wave;
  return work;
}

double DynamicsSeconds(const ModelWork& work, EngineKind engine) {
  WorldSpec world = work.world;
  world.integrator.engine = engine;
  const auto dynamics = MakeDynamics(world);
  const RobotModel& model = work.model();
  const int root = model.root;
  std::vector<int> moving;
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    if (model.joints[i].kind != JointKind::kFixed) moving.push_back(static_cast<int>(i));
  }
  std::vector<JointState> joints(moving.size());
  LinkState link;
  const double start_s = CpuSeconds();
  for (int sample = 1; sample <= work.samples; ++sample) {
    const VirtualTime now = VirtualTime() + work.period * sample;
    dynamics->AdvanceTo(now);
    dynamics->ReadLinks(now, {&root, 1}, {&link, 1});
    if (!moving.empty()) dynamics->ReadJoints(now, moving, joints);
    const VirtualTime at = now + work.answers_after;
    if (work.speeds_radps != nullptr) {
      const std::vector<double> speeds = work.speeds_radps(sample, model);
      for (std::size_t i = 0; i < speeds.size(); ++i) {
        dynamics->Spin(static_cast<int>(i), speeds[i], at);
      }
    }
    if (work.drives != nullptr) {
      const std::vector<JointDrive> drives = work.drives(sample, model);
      for (std::size_t i = 0; i < moving.size(); ++i) dynamics->Drive(moving[i], drives[i], at);
    }
  }
  return CpuSeconds() - start_s;
}

}  // namespace tcs::bench
