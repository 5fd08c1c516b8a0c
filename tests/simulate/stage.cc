#include "tests/simulate/stage.h"

#include <stdarg.h>
#include <stdio.h>

#include <cstdlib>
#include <string>
#include <utility>

#include "simbody_bridge/library/physics_library.h"
#include "tests/simulate/broken.h"

namespace tcs::simulate {

void Broken(const char* what, ...) {
  va_list arguments;
  va_start(arguments, what);
  vfprintf(stderr, what, arguments);
  va_end(arguments);
  fprintf(stderr, "\n");
  abort();
}

void Stage::Begin(const Robots& robots, bool is_fixed, bool has_levels) {
  run_.reset();
  Scenario scenario;
  scenario.duration = VirtualDuration::Seconds(7200);
  scenario.drift_bound = VirtualNs(robots.drift_ns);
  if (robots.has_world) {
    SetPhysicsLibrary(TCS_PHYSICS_LIBRARY);
    scenario.world.emplace().bodies.emplace_back().name = "ball";
  }
  for (int i = 0; i < robots.count; ++i) {
    RobotSpec& spec = scenario.robots.emplace_back();
    spec.name = "robot" + std::to_string(i);
    spec.cores = robots.cores;
    spec.speed = robots.speed;
    spec.wakeup = robots.wakeup;
    spec.is_ideal = robots.is_ideal;
    spec.scheduler = robots.scheduler;
  }
  run_ = std::make_unique<SimulatedRun>(std::move(scenario), ++hosts_, has_levels, is_fixed);
}

Task& Stage::Add(const Client& client, std::function<void()> body) {
  ClientSpec& spec = specs_.emplace_back();
  spec.name = "robot" + std::to_string(client.robot) + "/client";
  spec.priority = client.priority;
  spec.deadline = client.deadline;
  run_->AddClient(run().robots[static_cast<std::size_t>(client.robot)], spec);
  return AddBeside(std::move(body));
}

Task& Stage::AddBeside(std::function<void()> body) {
  return run_->AddThread([body = std::move(body)](const preload::GuestThread& guest) {
    Attach(guest);
    body();
    for (;;) SleepUntil(ReadClock() + 10'000 * kSecond);
  });
}

bool Stage::StepUntil(const std::function<bool()>& is_so, int most) {
  for (int step = 0; step < most; ++step) {
    if (is_so()) return true;
    if (!run_->all().loop.Step()) return is_so();
  }
  return false;
}

}  // namespace tcs::simulate
