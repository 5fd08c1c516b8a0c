// Small worlds and comparisons for the tests of Dynamics.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/engines.h"

namespace tcs {

inline VirtualTime At(std::int64_t ns) { return VirtualTime::FromNanoseconds(ns); }
inline VirtualTime AtMs(std::int64_t ms) { return At(ms * 1'000'000); }

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

inline constexpr double kMass = 2.0;  // of OneBody
inline WorldSpec OneBody(const IntegratorSpec& integrator = {}) {
  WorldSpec world;
  world.bodies.push_back(
      {.name = "ship", .mass_kg = kMass, .inertia_kgm2 = {0.1, 0.2, 0.25}, .initial = {}});
  world.integrator = integrator;
  return world;
}

// Two bodies that tumble and run into stiff walls: error control has work to do.
inline WorldSpec BusyWorld(const IntegratorSpec& integrator) {
  WorldSpec world;
  world.integrator = integrator;
  world.gravity_mps2 = {0, 0, -9.81};
  world.has_region = true;
  world.region = {.half_extent_m = 1.0, .stiffness_npm = 2000.0, .damping_nspm = 1.0};
  for (const double side : {-1.0, 1.0}) {
    BodySpec body{.name = side < 0 ? "left" : "right",
                  .mass_kg = 1.5,
                  .inertia_kgm2 = {0.1, 0.2, 0.25},
                  .initial = {}};
    body.initial.position_m = {0.5 * side, 0, 0};
    body.initial.linear_velocity_mps = {-3 * side, 1, 0.5};
    body.initial.angular_velocity_radps = {0.1, 6 * side, 0.2};
    world.bodies.push_back(body);
  }
  return world;
}

// The same in the air, with gusts.
inline WorldSpec BusyWorldInTheWind(const IntegratorSpec& integrator) {
  WorldSpec world = BusyWorld(integrator);
  world.wind = {.mean_mps = {2, -1, 0},
                .gusts_mps = 1.5,
                .gust_time = VirtualDuration::Milliseconds(500),
                .seed = 4};
  world.bodies[1].drag = {.linear_nspm = 0.3,
                          .quadratic_ns2pm2 = 0.1,
                          .angular_linear_nmsprad = 0.02,
                          .angular_quadratic_nms2prad2 = 0.01};
  return world;
}

inline constexpr std::array kAllKinds = {
    IntegratorKind::kRungeKutta3, IntegratorKind::kRungeKuttaMerson, IntegratorKind::kVerlet,
    IntegratorKind::kSemiExplicitEuler2, IntegratorKind::kExplicitEuler};

inline std::string NameOf(IntegratorKind kind) {
  switch (kind) {
    case IntegratorKind::kRungeKutta3:
      return "RungeKutta3";
    case IntegratorKind::kRungeKuttaMerson:
      return "RungeKuttaMerson";
    case IntegratorKind::kVerlet:
      return "Verlet";
    case IntegratorKind::kSemiExplicitEuler2:
      return "SemiExplicitEuler2";
    case IntegratorKind::kExplicitEuler:
      return "ExplicitEuler";
  }
  return "unknown";
}

inline constexpr IntegratorSpec kOde{.engine = EngineKind::kOde};

inline std::vector<IntegratorSpec> FixedAndAdaptive() {
  std::vector<IntegratorSpec> specs;
  for (const IntegratorKind kind : kAllKinds) {
    specs.push_back({.kind = kind, .fixed_step = VirtualDuration::Microseconds(700)});
    specs.push_back({.kind = kind, .fixed_step = {}, .accuracy = 1e-4});
  }
  specs.push_back({.engine = EngineKind::kOde, .fixed_step = VirtualDuration::Microseconds(700)});
  specs.push_back(kOde);
  return specs;
}

// Every method with steps of one length.
inline std::vector<IntegratorSpec> EveryMethod(VirtualDuration step) {
  std::vector<IntegratorSpec> specs;
  for (const IntegratorKind kind : kAllKinds) {
    specs.push_back({.kind = kind, .fixed_step = step});
  }
  specs.push_back({.engine = EngineKind::kOde, .fixed_step = step});
  return specs;
}

inline std::string NameOf(const IntegratorSpec& spec) {
  return spec.engine == EngineKind::kOde ? "Ode" : NameOf(spec.kind);
}

inline bool IsExplicitEuler(const IntegratorSpec& spec) {
  return spec.engine == EngineKind::kSimbody && spec.kind == IntegratorKind::kExplicitEuler;
}

// Its error falls with the step and not with a power of it.
inline bool IsFirstOrder(const IntegratorSpec& spec) {
  return spec.engine == EngineKind::kOde || IsExplicitEuler(spec) ||
         spec.kind == IntegratorKind::kSemiExplicitEuler2;
}

class EveryIntegrator : public testing::TestWithParam<IntegratorSpec> {};

inline std::string NameOfParam(const testing::TestParamInfo<IntegratorSpec>& info) {
  if (info.param.engine == EngineKind::kOde) {
    return info.param.fixed_step > VirtualDuration{} ? "OdeFixed" : "Ode";
  }
  return NameOf(info.param.kind) +
         (info.param.fixed_step > VirtualDuration{} ? "Fixed" : "Adaptive");
}

// The engines, each as it is by default.
class EveryEngine : public testing::TestWithParam<IntegratorSpec> {};

inline std::vector<IntegratorSpec> Engines() {
  std::vector<IntegratorSpec> engines = {IntegratorSpec{}, kOde};
#ifdef TCS_HAS_MUJOCO
  engines.push_back({.engine = EngineKind::kMujoco});
#endif
  return engines;
}

inline std::string NameOfEngine(const testing::TestParamInfo<IntegratorSpec>& info) {
  if (info.param.engine == EngineKind::kMujoco) return "Mujoco";
  return info.param.engine == EngineKind::kOde ? "Ode" : "Simbody";
}

// What GoogleTest shows of a parameter, instead of its bytes.
inline void PrintTo(const IntegratorSpec& spec, std::ostream* out) {
  *out << TraitsOf(spec.engine).name << ", "
       << (spec.fixed_step.ns() == 0 ? "steps of its own"
                                     : "steps of " + std::to_string(spec.fixed_step.ns()) + " ns");
}

// How far a constant `acceleration_mps2` over `seconds` may take a body from where the closed form
// has it.
inline double PositionTolerance(const IntegratorSpec& spec, double acceleration_mps2,
                                double seconds) {
  const double euler_m = std::abs(acceleration_mps2) * kOdeStep.seconds() * seconds / 2;
  return spec.engine == EngineKind::kOde ? 1.01 * euler_m + 1e-14 : 1e-14;
}

inline bool SameBits(const BodyState& a, const BodyState& b) {
  static_assert(sizeof(BodyState) == 13 * sizeof(double), "BodyState has padding or a new member");
  return std::memcmp(&a, &b, sizeof a) == 0;
}

inline std::vector<BodyState> ReadAll(Dynamics& dynamics, int bodies) {
  std::vector<BodyState> states;
  for (int i = 0; i < bodies; ++i) states.push_back(dynamics.Read(i));
  return states;
}

inline bool SameBits(const std::vector<BodyState>& a, const std::vector<BodyState>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!SameBits(a[i], b[i])) return false;
  }
  return true;
}

}  // namespace tcs
