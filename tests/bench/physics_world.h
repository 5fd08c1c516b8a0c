// The bodies of the physics' rows, and what pushes them.
#pragma once

#include <time.h>

#include "simbody_bridge/dynamics.h"

namespace tcs::bench {

inline constexpr VirtualDuration kSamplePeriod = VirtualDuration::Milliseconds(10);

inline double CpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Bodies that drift and tumble between the walls of a region.
inline WorldSpec PhysicsWorld(int bodies) {
  WorldSpec world;
  world.has_region = true;
  BodySpec body{.name = "body", .mass_kg = 2, .inertia_kgm2 = {0.1, 0.2, 0.25}, .initial = {}};
  body.initial.linear_velocity_mps = {0.1, 0.2, 0.3};
  body.initial.angular_velocity_radps = {0.1, 0.2, 0.3};
  world.bodies.assign(static_cast<std::size_t>(bodies), body);
  return world;
}

inline WorldSpec PhysicsWorldOfUnlikeBodies(int bodies) {
  WorldSpec world = PhysicsWorld(bodies);
  double more_kg = 0;
  for (BodySpec& body : world.bodies) body.mass_kg += more_kg += 0.001;
  return world;
}

// Another one after each sample.
inline Wrench ChangingWrench(int sample) {
  return {.force_n = {1.0 * (sample % 5) - 2, 0, 0},
          .torque_nm = {0, 0.01 * (sample % 3) - 0.01, 0}};
}

}  // namespace tcs::bench
