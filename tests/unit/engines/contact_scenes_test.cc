// Scenes of contact on each engine: how they go is left to the engine, how they end is not.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "simbody_bridge/model/model_check.h"
#include "tests/unit/dynamics/test_models.h"
#include "tests/unit/models/model_folder.h"

namespace tcs {
namespace {

class ContactScenes : public EveryModelEngine {};

INSTANTIATE_TEST_SUITE_P(Engines, ContactScenes, testing::ValuesIn(ModelEngines()), NameOfEngine);

RobotModel Zoo(const std::string& file) {
  const Loaded loaded = LoadFile(ZooPath(file));
  EXPECT_EQ(loaded.mistake, "");
  return loaded.model;
}

// How high above each other the boxes of a stack are after three seconds, each of which lies
// `shift_m` beside the one below.
std::vector<double> HeightsOfStack(const IntegratorSpec& engine, double shift_m) {
  WorldSpec world = WorldOf({}, engine);
  world.fixtures = {Floor()};
  for (int i = 0; i < 4; ++i) {
    const Pose at{{shift_m * i, 0, 0.1 + 0.2 * i}, {0, 0, 0, 1}};
    world.models.push_back(
        Loose("box" + std::to_string(i), BoxShape{{0.2, 0.2, 0.2}}, at, 1, 0.8, 1.0 / 150));
  }
  auto dynamics = MakeDynamics(world);
  std::vector<double> heights;
  for (int i = 0; i < 4; ++i) {
    heights.push_back(ReadLink(*dynamics, i, AtMs(3000)).pose.position_m[2]);
  }
  return heights;
}

// What lies on a box has its centre of mass 2 shifts beside it: over it for less than 0.05 m.
TEST_P(ContactScenes, AStackStandsAsLongAsItsWeightIsOverIt) {
  const std::vector<double> standing = HeightsOfStack(GetParam(), 0.04);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(standing[i], 0.1 + 0.2 * static_cast<double>(i), 3e-3) << i;
  }
  const std::vector<double> fallen = HeightsOfStack(GetParam(), 0.06);
  EXPECT_NEAR(fallen[0], 0.1, 3e-3);
  EXPECT_LT(fallen[3], 0.45) << "the boxes above fall";
}

// A ball whose friction lets it roll comes down a slope at 5/7 g sin(slope).
TEST_P(ContactScenes, ABallRollsDownASlope) {
  constexpr double kRadius = 0.1, kSlope = 0.2;
  const Pose slope{{}, FromRollPitchYaw(0, kSlope, 0)};
  WorldSpec world =
      WorldOf({Loose("ball", SphereShape{kRadius},
                     Times(slope, Pose{{0, 0, kRadius}, {0, 0, 0, 1}}), 1, 0.8, 0.004)},
              GetParam());
  world.fixtures = {Floor(0.8, kSlope)};
  auto dynamics = MakeDynamics(world);
  const LinkState state = ReadLink(*dynamics, 0, AtMs(2000));
  const auto down = Rotate(slope.orientation_xyzw, {1, 0, 0});
  const double way = state.pose.position_m[0] * down[0] + state.pose.position_m[2] * down[2];
  EXPECT_NEAR(way, 5.0 / 7 * kG * std::sin(kSlope) * 2, 0.005 * way);
  const double speed = std::hypot(state.linear_velocity_mps[0], state.linear_velocity_mps[2]);
  EXPECT_NEAR(state.angular_velocity_radps[1] * kRadius, speed, 0.005 * speed);
}

// A rover that servos of its wheels drive, and that drags a caster: whatever their gain, once it is
// under way its wheels roll.
TEST_P(ContactScenes, ARoversWheelsRoll) {
  const RobotModel rover = Zoo("rover.urdf");
  for (const double friction : {0.8, 1.0}) {
    for (const double damping : {2.0, 20.0, 200.0}) {
      WorldSpec world = WorldOf({rover}, GetParam());
      world.fixtures = {Floor()};
      for (Link& link : world.models[0].links) {
        for (Shape& shape : link.shapes) shape.friction = friction;
      }
      world.fixtures[0].friction = friction;
      auto dynamics = MakeDynamics(world);
      constexpr double kSpeed = 3.75, kRadius = 0.08;
      const int left = *dynamics->FindJoint("rover", "left_wheel_joint");
      const int right = *dynamics->FindJoint("rover", "right_wheel_joint");
      const int body = *dynamics->FindLink("rover", "base_link");
      for (const int wheel : {left, right}) {
        dynamics->Drive(wheel, {.damping = damping, .velocity = kSpeed}, AtMs(300));
      }
      const double began = ReadLink(*dynamics, body, AtMs(2000)).pose.position_m[0];
      const double turned = ReadJoint(*dynamics, left, AtMs(2000)).position;
      const LinkState state = ReadLink(*dynamics, body, AtMs(6000));
      const double way = state.pose.position_m[0] - began;
      const double rolled = (ReadJoint(*dynamics, left, AtMs(6000)).position - turned) * kRadius;
      EXPECT_NEAR(way, rolled, 0.005 * rolled)
          << "damping " << damping << ", friction " << friction;
      EXPECT_GT(rolled, 0.8 * kSpeed * kRadius * 4);
      EXPECT_NEAR(state.pose.position_m[2], 0.1, 2e-3);
      EXPECT_NEAR(state.pose.position_m[1], 0, 0.02);
    }
  }
}

// Nothing holds its joints; its knees are bent as their limits want it.
WorldSpec LimpQuadruped(double height_m, const IntegratorSpec& integrator) {
  RobotModel quadruped = Zoo("quadruped.urdf");
  for (Joint& joint : quadruped.joints) {
    if (joint.name.ends_with("knee")) joint.initial_position = {-1.4};
    if (joint.name.ends_with("hip_pitch")) joint.initial_position = {0.7};
  }
  quadruped.at.position_m = {0, 0, height_m};
  WorldSpec world = WorldOf({quadruped}, integrator);
  world.fixtures = {Floor()};
  return world;
}

// It falls onto its feet, which servos hold, and stands.
TEST_P(ContactScenes, AQuadrupedThatFallsOntoItsFeetStands) {
  RobotModel quadruped = Zoo("quadruped.urdf");
  std::vector<double> posture;
  for (Joint& joint : quadruped.joints) {
    const bool is_knee = joint.name.ends_with("knee"), is_hip = joint.name.ends_with("hip_pitch");
    posture.push_back(is_knee ? -1.4 : is_hip ? 0.7 : 0);
    if (joint.kind != JointKind::kFixed) joint.initial_position = {posture.back()};
  }
  quadruped.at.position_m = {0, 0, 0.5};
  ASSERT_FALSE(CheckModel(quadruped).has_value());
  WorldSpec world = WorldOf({quadruped}, GetParam());
  world.fixtures = {Floor()};
  auto dynamics = MakeDynamics(world);
  for (std::size_t i = 0; i < quadruped.joints.size(); ++i) {
    if (quadruped.joints[i].kind == JointKind::kFixed) continue;
    dynamics->Drive(static_cast<int>(i), {.stiffness = 200, .position = posture[i], .damping = 4},
                    AtMs(0));
  }
  const LinkState state = ReadLink(*dynamics, 0, AtMs(3000));
  RecordProperty("height", std::to_string(state.pose.position_m[2]));
  // Thighs of 0.21 m and shanks of 0.2 m at 0.7 rad, on feet of 0.02 m, a little bent by its
  // weight.
  const double straight = (0.21 + 0.2) * std::cos(0.7) + 0.02;
  EXPECT_NEAR(state.pose.position_m[2], straight, 0.03);
  EXPECT_GT(Rotate(state.pose.orientation_xyzw, {0, 0, 1})[2], 0.995) << "upright";
  for (const double speed : state.linear_velocity_mps) EXPECT_NEAR(speed, 0, 2e-3);

  // Its feet alone touch the floor, and carry all of it.
  double mass_kg = 0, held_n = 0;
  for (const Link& link : quadruped.links) mass_kg += link.inertial ? link.inertial->mass_kg : 0;
  std::vector<ContactForce> contacts;
  dynamics->ReadContacts(AtMs(3000), &contacts);
  std::set<int> feet;
  for (const ContactForce& contact : contacts) {
    const Link& link = world.models[0].links[static_cast<std::size_t>(contact.first)];
    EXPECT_THAT(link.name, testing::HasSubstr("foot"));
    EXPECT_EQ(contact.fixture, 0);
    feet.insert(contact.first);
    held_n += contact.force_n[2];
  }
  EXPECT_EQ(feet.size(), 4u);
  EXPECT_NEAR(held_n, mass_kg * kG, 0.01 * mass_kg * kG);
}

TEST_P(ContactScenes, AQuadrupedTouchesNothingBeforeItLands) {
  auto dynamics = MakeDynamics(LimpQuadruped(1, GetParam()));
  std::vector<ContactForce> contacts;
  dynamics->ReadContacts(AtMs(200), &contacts);
  EXPECT_TRUE(contacts.empty());
  dynamics->ReadContacts(AtMs(700), &contacts);
  EXPECT_FALSE(contacts.empty());
}

// Limp, it lies on its belly.
TEST_P(ContactScenes, AQuadrupedWithoutPowerLiesDown) {
  auto dynamics = MakeDynamics(LimpQuadruped(0.5, GetParam()));
  const LinkState state = ReadLink(*dynamics, 0, AtMs(4000));
  EXPECT_LT(state.pose.position_m[2], 0.13);
  EXPECT_GT(state.pose.position_m[2], 0.05) << "its trunk is 0.11 m high";
  for (const double speed : state.linear_velocity_mps) EXPECT_NEAR(speed, 0, 5e-3);
}

}  // namespace
}  // namespace tcs
