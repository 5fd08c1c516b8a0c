// Small models for the tests of Dynamics.
#pragma once

#include <array>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "simbody_bridge/model/pose.h"
#include "tests/unit/dynamics/test_worlds.h"

namespace tcs {

inline constexpr double kG = 9.81;
inline constexpr double kPi = std::numbers::pi;

// The engines that have models, each as it is by default.
inline std::vector<IntegratorSpec> ModelEngines() {
  std::vector<IntegratorSpec> engines = {IntegratorSpec{}};
#ifdef TCS_HAS_MUJOCO
  engines.push_back({.engine = EngineKind::kMujoco});
#endif
  return engines;
}

class EveryModelEngine : public testing::TestWithParam<IntegratorSpec> {};

inline Inertial MassAt(double mass_kg, const std::array<double, 3>& center_m, double moment_kgm2) {
  Inertial inertial;
  inertial.mass_kg = mass_kg;
  inertial.frame.position_m = center_m;
  inertial.ixx_kgm2 = inertial.iyy_kgm2 = inertial.izz_kgm2 = moment_kgm2;
  return inertial;
}

inline Link LinkOf(const std::string& name, const Inertial& inertial) {
  return {.name = name, .inertial = inertial, .shapes = {}};
}

inline Joint JointOf(const std::string& name, JointKind kind, int parent, int child,
                     const std::array<double, 3>& axis, const std::array<double, 3>& at = {}) {
  Joint joint;
  joint.name = name;
  joint.kind = kind;
  joint.parent = parent;
  joint.child = child;
  joint.axis = axis;
  joint.origin.position_m = at;
  return joint;
}

// Rods that hang one on the other below a fixed base and swing about y: the angle is 0 where a rod
// hangs straight down from the one before.
inline RobotModel Pendulum(int rods, double length_m = 1, double mass_kg = 1,
                           double moment_kgm2 = 0.01) {
  RobotModel model;
  model.name = "pendulum";
  model.has_fixed_base = true;
  model.links.push_back({.name = "base", .inertial = {}, .shapes = {}});
  for (int i = 0; i < rods; ++i) {
    const std::string number = std::to_string(i + 1);
    model.links.push_back(LinkOf("rod" + number, MassAt(mass_kg, {0, 0, -length_m}, moment_kgm2)));
    model.joints.push_back(JointOf("hinge" + number, JointKind::kRevolute, i, i + 1, {0, 1, 0},
                                   {0, 0, i == 0 ? 0 : -length_m}));
  }
  return model;
}

inline Shape ShapeOf(const Geometry& geometry, double friction = 0.8, const Pose& pose = {}) {
  return {.name = "", .geometry = geometry, .pose = pose, .friction = friction};
}

inline Shape Floor(double friction = 0.8, double slope_rad = 0) {
  return ShapeOf(PlaneShape{}, friction, {{}, FromRollPitchYaw(0, slope_rad, 0)});
}

// A body that floats, with one shape around its center.
inline RobotModel Loose(const std::string& name, const Geometry& geometry, const Pose& at,
                        double mass_kg = 1, double friction = 0.8, double moment_kgm2 = 0.01) {
  RobotModel model;
  model.name = name;
  model.links.push_back(LinkOf(name, MassAt(mass_kg, {}, moment_kgm2)));
  model.links[0].shapes.push_back(ShapeOf(geometry, friction));
  model.at = at;
  return model;
}

inline WorldSpec WorldOf(std::vector<RobotModel> models, const IntegratorSpec& integrator) {
  WorldSpec world;
  world.gravity_mps2 = {0, 0, -kG};
  world.models = std::move(models);
  world.integrator = integrator;
  return world;
}

inline JointState ReadJoint(Dynamics& dynamics, int joint, VirtualTime t) {
  JointState state;
  dynamics.ReadJoints(t, {&joint, 1}, {&state, 1});
  return state;
}
inline LinkState ReadLink(Dynamics& dynamics, int link, VirtualTime t) {
  LinkState state;
  dynamics.ReadLinks(t, {&link, 1}, {&state, 1});
  return state;
}

}  // namespace tcs
