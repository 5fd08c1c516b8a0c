#include "tests/zoo/exercise.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>
#include <variant>

#include "coordinator/scenario/load.h"

namespace tcs::zoo {
namespace {

constexpr VirtualDuration kEach = VirtualDuration::Milliseconds(20);
constexpr double kFarM = 200, kFastRadps = 1e5;
// Of joints of which nobody says what they can.
constexpr double kSomeEffort = 10;

double CpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::vector<int> DrivenJoints(const RobotModel& model) {
  std::vector<int> driven;
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const Joint& joint = model.joints[i];
    if (CoordinatesOf(joint.kind) == 1 && !joint.mimic) driven.push_back(static_cast<int>(i));
  }
  return driven;
}

// As stiff as that a fifth of a radian off asks for all that the joint can.
JointDrive ServoOf(const Joint& joint, double off) {
  const double effort = std::isfinite(joint.limits.effort) ? joint.limits.effort : kSomeEffort;
  const double start = joint.initial_position.empty() ? 0 : joint.initial_position.front();
  return {.stiffness = 5 * effort,
          .position = std::clamp(start + off, joint.limits.lower, joint.limits.upper),
          .damping = 0.2 * effort};
}

std::string WrongOf(const RobotModel& model, Dynamics& dynamics, VirtualTime t,
                    const std::vector<int>& driven) {
  std::vector<int> links(model.links.size());
  std::iota(links.begin(), links.end(), 0);
  std::vector<LinkState> states(links.size());
  dynamics.ReadLinks(t, links, states);
  for (std::size_t i = 0; i < links.size(); ++i) {
    const auto& p = states[i].pose.position_m;
    if (std::hypot(p[0], p[1], p[2]) < kFarM) continue;
    return fmt::format("link '{}' is {} m away at {} s", model.links[i].name,
                       std::hypot(p[0], p[1], p[2]), t.seconds());
  }
  std::vector<JointState> joints(driven.size());
  dynamics.ReadJoints(t, driven, joints);
  for (std::size_t i = 0; i < driven.size(); ++i) {
    if (std::abs(joints[i].velocity) < kFastRadps) continue;
    return fmt::format("joint '{}' has the speed {} at {} s",
                       model.joints[static_cast<std::size_t>(driven[i])].name, joints[i].velocity,
                       t.seconds());
  }
  return {};
}

}  // namespace

const char* NameOf(Manner manner) {
  switch (manner) {
    case Manner::kFree:
      return "free";
    case Manner::kHeld:
      return "held";
    case Manner::kMoved:
      break;
  }
  return "moved";
}

bool HasRobots(const EngineTraits& engine) {
#ifndef TCS_HAS_MUJOCO
  if (engine.kind == EngineKind::kMujoco) return false;
#endif
  return engine.has_models;
}

LoadedRobot LoadRobot(const std::filesystem::path& scenario) {
  LoadedRobot robot;
  const double start_s = CpuSeconds();
  auto loaded = LoadScenario(scenario.string(), {});
  robot.load_s = CpuSeconds() - start_s;
  if (const auto* error = std::get_if<LoadError>(&loaded)) {
    robot.mistake = error->message;
    return robot;
  }
  auto& of = std::get<Scenario>(loaded);
  robot.world = std::move(*of.world);
  robot.warnings = of.warnings;
  return robot;
}

Exercise Perform(WorldSpec world, EngineKind engine, Manner manner, VirtualDuration duration) {
  world.integrator.engine = engine;
  const RobotModel& model = world.models.front();
  const std::vector<int> driven = DrivenJoints(model);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> draw(-0.3, 0.3);
  Exercise exercise;
  try {
    const auto dynamics = MakeDynamics(world);
    const double start_s = CpuSeconds();
    const VirtualTime end = VirtualTime() + duration;
    for (VirtualTime t; t < end; t += kEach) {
      if (manner == Manner::kMoved || (manner == Manner::kHeld && t == VirtualTime())) {
        for (const int joint : driven) {
          const double off = manner == Manner::kMoved ? draw(random) : 0;
          dynamics->Drive(joint, ServoOf(model.joints[static_cast<std::size_t>(joint)], off), t);
        }
      }
      dynamics->AdvanceTo(t + kEach);
      exercise.wrong = WrongOf(model, *dynamics, t + kEach, driven);
      if (!exercise.wrong.empty()) break;
    }
    exercise.cpu_s = CpuSeconds() - start_s;
    exercise.steps = dynamics->work().steps;
  } catch (const DynamicsError& error) {
    exercise.wrong = error.what();
  }
  return exercise;
}

}  // namespace tcs::zoo
