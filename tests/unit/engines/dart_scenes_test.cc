// Scenes of contact on each engine and on DART beside it: they end alike. On DART a quadruped has
// no cylinders to touch the floor with (its hips): without power it lies deeper.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "tests/unit/dynamics/test_models.h"
#include "tests/unit/engines/dart_scene.h"
#include "tests/unit/models/model_folder.h"

namespace tcs {
namespace {

class ScenesBesideDart : public EveryModelEngine {
 protected:
  // The states of the models, each of one link, after so long: on the engine, then on DART.
  static std::array<std::vector<LinkState>, 2> EndsOf(const WorldSpec& world, int ms) {
    std::array<std::vector<LinkState>, 2> ends;
    auto dynamics = MakeDynamics(world);
    DartScene dart(world);
    dart.Advance(1e-3 * ms);
    for (std::size_t i = 0; i < world.models.size(); ++i) {
      ends[0].push_back(ReadLink(*dynamics, static_cast<int>(i), AtMs(ms)));
      ends[1].push_back(dart.StateOf(world.models[i].name));
    }
    return ends;
  }
};

INSTANTIATE_TEST_SUITE_P(Engines, ScenesBesideDart, testing::ValuesIn(ModelEngines()),
                         NameOfEngine);

Pose Slope(double slope_rad) { return {{}, FromRollPitchYaw(0, slope_rad, 0)}; }

double WayDown(const LinkState& state, double slope_rad) {
  return state.pose.position_m[0] * std::cos(slope_rad) -
         state.pose.position_m[2] * std::sin(slope_rad);
}

WorldSpec Stack(double shift_m, const IntegratorSpec& engine) {
  WorldSpec world = WorldOf({}, engine);
  world.fixtures = {Floor()};
  for (int i = 0; i < 4; ++i) {
    const Pose at{{shift_m * i, 0, 0.1 + 0.2 * i}, {0, 0, 0, 1}};
    world.models.push_back(
        Loose("box" + std::to_string(i), BoxShape{{0.2, 0.2, 0.2}}, at, 1, 0.8, 1.0 / 150));
  }
  return world;
}

TEST_P(ScenesBesideDart, AStackStandsAsLongAsItsWeightIsOverIt) {
  for (const std::vector<LinkState>& standing : EndsOf(Stack(0.04, GetParam()), 3000)) {
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(standing[i].pose.position_m[2], 0.1 + 0.2 * static_cast<double>(i), 3e-3) << i;
      EXPECT_NEAR(standing[i].pose.position_m[0], 0.04 * static_cast<double>(i), 5e-3) << i;
    }
  }
  for (const std::vector<LinkState>& fallen : EndsOf(Stack(0.06, GetParam()), 3000)) {
    EXPECT_NEAR(fallen[0].pose.position_m[2], 0.1, 3e-3);
    EXPECT_LT(fallen[3].pose.position_m[2], 0.45) << "the boxes above fall";
  }
}

TEST_P(ScenesBesideDart, ABallRollsDownASlope) {
  constexpr double kRadius = 0.1, kSlope = 0.2;
  const Pose at = Times(Slope(kSlope), Pose{{0, 0, kRadius}, {0, 0, 0, 1}});
  WorldSpec world = WorldOf({Loose("ball", SphereShape{kRadius}, at, 1, 0.8, 0.004)}, GetParam());
  world.fixtures = {Floor(0.8, kSlope)};
  for (const std::vector<LinkState>& end : EndsOf(world, 2000)) {
    const double way = 5.0 / 7 * kG * std::sin(kSlope) * 2;
    EXPECT_NEAR(WayDown(end[0], kSlope) - WayDown({at, {}, {}}, kSlope), way, 0.005 * way);
    const auto& v = end[0].linear_velocity_mps;
    const double speed = std::hypot(v[0], v[2]);
    EXPECT_NEAR(end[0].angular_velocity_radps[1] * kRadius, speed, 0.005 * speed) << "it rolls";
  }
}

TEST_P(ScenesBesideDart, ABlockOnAnInclineSlidesBeyondTheFrictionAngle) {
  for (const double friction : {0.3, 0.8}) {
    for (const double beyond : {-0.005, 0.005}) {
      const double slope = std::atan(friction) + beyond;
      const Pose at = Times(Slope(slope), Pose{{0, 0, 0.1}, {0, 0, 0, 1}});
      WorldSpec world = WorldOf(
          {Loose("block", BoxShape{{0.2, 0.2, 0.2}}, at, 1, friction, 1.0 / 150)}, GetParam());
      world.fixtures = {Floor(1.5, slope)};
      // What is left of its weight moves it by so much in two seconds.
      const double way = 2 * kG * (std::sin(slope) - friction * std::cos(slope));
      for (const std::vector<LinkState>& end : EndsOf(world, 2000)) {
        const double slid = WayDown(end[0], slope) - WayDown({at, {}, {}}, slope);
        if (beyond < 0) {
          EXPECT_LT(std::abs(slid), 1e-3) << friction;
        } else {
          EXPECT_NEAR(slid, way, 0.05 * way) << friction;
        }
      }
    }
  }
}

// One that falls, with servos of that stiffness and damping.
struct Fallen {
  LinkState engine, dart;
  double lift_n = 0;  // what holds it, on DART
  double mass_kg = 0;
};

Fallen Fall(double stiffness, double damping, const IntegratorSpec& engine) {
  Loaded loaded = LoadFile(ZooPath("quadruped.urdf"));
  EXPECT_EQ(loaded.mistake, "");
  RobotModel& quadruped = loaded.model;
  for (Joint& joint : quadruped.joints) {
    if (joint.kind == JointKind::kFixed) continue;
    const bool is_knee = joint.name.ends_with("knee"), is_hip = joint.name.ends_with("hip_pitch");
    joint.initial_position = {is_knee ? -1.4 : is_hip ? 0.7 : 0};
  }
  quadruped.at.position_m = {0, 0, 0.5};
  WorldSpec world = WorldOf({}, engine);
  world.fixtures = {Floor()};
  DartScene dart(world);
  dart.AddRobot(ZooPath("quadruped.urdf"), quadruped, 0.8, stiffness, damping);
  dart.Advance(4);
  world.models = {quadruped};
  auto dynamics = MakeDynamics(world);
  for (std::size_t i = 0; i < quadruped.joints.size(); ++i) {
    const Joint& joint = quadruped.joints[i];
    if (joint.kind == JointKind::kFixed || stiffness == 0) continue;
    dynamics->Drive(
        static_cast<int>(i),
        {.stiffness = stiffness, .position = joint.initial_position[0], .damping = damping},
        AtMs(0));
  }
  Fallen fallen{ReadLink(*dynamics, 0, AtMs(4000)), dart.StateOf(quadruped.name),
                dart.LiftOn(quadruped.name), 0};
  for (const Link& link : quadruped.links) {
    fallen.mass_kg += link.inertial ? link.inertial->mass_kg : 0;
  }
  return fallen;
}

void ExpectAtRest(const LinkState& state) {
  for (const double speed : state.linear_velocity_mps) EXPECT_NEAR(speed, 0, 5e-3);
  for (const double speed : state.angular_velocity_radps) EXPECT_NEAR(speed, 0, 5e-2);
}

TEST_P(ScenesBesideDart, AQuadrupedThatFallsOntoItsFeetStands) {
  const Fallen fallen = Fall(200, 4, GetParam());
  ExpectAtRest(fallen.engine);
  ExpectAtRest(fallen.dart);
  EXPECT_NEAR(fallen.engine.pose.position_m[2], fallen.dart.pose.position_m[2], 1e-2);
  EXPECT_GT(Rotate(fallen.engine.pose.orientation_xyzw, {0, 0, 1})[2], 0.995);
  EXPECT_GT(Rotate(fallen.dart.pose.orientation_xyzw, {0, 0, 1})[2], 0.995);
  EXPECT_NEAR(fallen.lift_n, fallen.mass_kg * kG, 0.01 * fallen.mass_kg * kG);
}

TEST_P(ScenesBesideDart, AQuadrupedWithoutPowerLiesDown) {
  const Fallen fallen = Fall(0, 0, GetParam());
  for (const LinkState& state : {fallen.engine, fallen.dart}) {
    ExpectAtRest(state);
    EXPECT_LT(state.pose.position_m[2], 0.13);
    EXPECT_GT(state.pose.position_m[2], 0.05) << "its trunk is 0.11 m high";
  }
}

}  // namespace
}  // namespace tcs
