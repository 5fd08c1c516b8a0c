// Models that touch the world and each other.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "tests/unit/dynamics/taken_back.h"
#include "tests/unit/dynamics/test_models.h"

namespace tcs {
namespace {

class ModelsInContact : public EveryModelEngine {};

INSTANTIATE_TEST_SUITE_P(Engines, ModelsInContact, testing::ValuesIn(ModelEngines()), NameOfEngine);

Geometry Cube(double edge_m) { return BoxShape{{edge_m, edge_m, edge_m}}; }

// A tetrahedron's, a cube's: corners only.
Geometry MeshOfCube(double edge_m) {
  auto mesh = std::make_shared<Mesh>();
  mesh->name = "cube";
  for (int i = 0; i < 8; ++i) {
    mesh->vertices_m.push_back(
        {((i & 1) - 0.5) * edge_m, ((i >> 1 & 1) - 0.5) * edge_m, ((i >> 2 & 1) - 0.5) * edge_m});
  }
  return MeshShape{mesh};
}

// How far it has slid down a slope of that angle after `ms`.
double Slide(const IntegratorSpec& spec, const Geometry& geometry, double slope_rad,
             double friction, int ms) {
  const Pose slope{{}, FromRollPitchYaw(0, slope_rad, 0)};
  WorldSpec world = WorldOf(
      {Loose("block", geometry, Times(slope, Pose{{0, 0, 0.1}, {0, 0, 0, 1}}), 1, friction)}, spec);
  world.fixtures = {Floor(1.5, slope_rad)};
  auto dynamics = MakeDynamics(world);
  const auto p = ReadLink(*dynamics, 0, AtMs(ms)).pose.position_m;
  const auto down = Rotate(slope.orientation_xyzw, {1, 0, 0});
  return p[0] * down[0] + p[2] * down[2];
}

TEST_P(ModelsInContact, ABlockOnAnInclineSlidesBeyondTheFrictionAngle) {
  for (const Geometry& geometry : {Cube(0.2), MeshOfCube(0.2)}) {
    // MuJoCo holds a mesh by some of its corners at a time, and it tilts as it slides.
    const bool tilts =
        GetParam().engine == EngineKind::kMujoco && std::holds_alternative<MeshShape>(geometry);
    for (const double friction : {0.3, 0.8}) {
      const double angle = std::atan(friction), tolerance = 0.2 * kPi / 180;
      EXPECT_LT(Slide(GetParam(), geometry, angle - tolerance, friction, 2000), tilts ? 2e-2 : 2e-3)
          << friction;
      // What is left of its weight moves it by so much in two seconds.
      const double way =
          2 * kG * (std::sin(angle + tolerance) - friction * std::cos(angle + tolerance));
      const double slid = Slide(GetParam(), geometry, angle + tolerance, friction, 2000);
      EXPECT_GT(slid, 0.6 * way) << friction;
      EXPECT_LT(slid, tilts ? 1 : 1.4 * way) << friction;
    }
  }
}

TEST_P(ModelsInContact, ABlockSlidesAsFarAsFrictionLetsIt) {
  RobotModel block = Loose("block", Cube(0.2), {{0, 0, 0.1}, {0, 0, 0, 1}}, 1, 0.5);
  block.linear_velocity_mps = {2, 0, 0};
  block.links[0].inertial->iyy_kgm2 = 0.015;
  WorldSpec world = WorldOf({block}, GetParam());
  world.fixtures = {Floor()};
  auto dynamics = MakeDynamics(world);
  const LinkState state = ReadLink(*dynamics, 0, AtMs(1500));
  const double expected = 4 / (2 * 0.5 * kG);
  EXPECT_NEAR(state.pose.position_m[0], expected, 0.02 * expected);
  EXPECT_NEAR(state.linear_velocity_mps[0], 0, 1e-3);
}

TEST_P(ModelsInContact, EveryShapeComesToRestWhereItTouches) {
  const struct {
    Geometry geometry;
    Pose at;
    double rests_at;
  } cases[] = {
      {Cube(0.2), {{0, 0, 0.3}, FromRollPitchYaw(0.1, 0.2, 0.3)}, 0.1},
      {MeshOfCube(0.2), {{0, 0, 0.3}, FromRollPitchYaw(0.1, 0.2, 0.3)}, 0.1},
      {SphereShape{0.15}, {{0, 0, 0.4}, {0, 0, 0, 1}}, 0.15},
      {CylinderShape{0.2, 0.1}, {{0, 0, 0.3}, FromRollPitchYaw(0.1, 0, 0)}, 0.05},
      {CapsuleShape{0.1, 0.3}, {{0, 0, 0.3}, FromRollPitchYaw(1.4, 0, 0)}, 0.1},
  };
  // On the floor, and on a box whose top is there.
  const std::vector<Shape> grounds = {
      Floor(), ShapeOf(BoxShape{{4, 4, 1}}, 0.8, {{0, 0, -0.5}, {0, 0, 0, 1}})};
  for (std::size_t ground = 0; ground < 2; ++ground) {
    for (std::size_t i = 0; i < std::size(cases); ++i) {
      WorldSpec world = WorldOf({Loose("thing", cases[i].geometry, cases[i].at)}, GetParam());
      world.fixtures = {grounds[ground]};
      auto dynamics = MakeDynamics(world);
      const LinkState state = ReadLink(*dynamics, 0, AtMs(4000));
      EXPECT_NEAR(state.pose.position_m[2], cases[i].rests_at, 1e-3)
          << "case " << i << " on ground " << ground;
      EXPECT_NEAR(state.linear_velocity_mps[2], 0, 1e-3) << i;
    }
  }
}

// A wheel that is thrown, and that a torque drives: what its hinge has turned is what it has
// rolled.
TEST_P(ModelsInContact, ARollingWheelComesAsFarAsItTurns) {
  RobotModel cart;
  cart.name = "cart";
  cart.links.push_back(LinkOf("frame", MassAt(2, {}, 0.05)));
  for (int i = 0; i < 4; ++i) {
    const double x = i < 2 ? 0.3 : -0.3, y = i % 2 == 0 ? 0.2 : -0.2;
    const std::string name = "wheel" + std::to_string(i);
    cart.links.push_back(LinkOf(name, MassAt(0.5, {}, 0.0025)));
    Joint joint = JointOf(name, JointKind::kContinuous, 0, i + 1, {0, 1, 0}, {x, y, 0});
    cart.joints.push_back(joint);
    cart.links.back().shapes.push_back(
        ShapeOf(CylinderShape{0.1, 0.04}, 0.9, {{}, FromRollPitchYaw(kPi / 2, 0, 0)}));
  }
  cart.at.position_m = {0, 0, 0.1};
  WorldSpec world = WorldOf({cart}, GetParam());
  world.fixtures = {Floor()};
  auto dynamics = MakeDynamics(world);
  for (int i = 0; i < 4; ++i) dynamics->Drive(i, {.effort = 0.05}, AtMs(200));
  const double start = ReadLink(*dynamics, 0, AtMs(200)).pose.position_m[0];
  const double turned = ReadJoint(*dynamics, 0, AtMs(200)).position;
  const LinkState state = ReadLink(*dynamics, 0, AtMs(2200));
  // 4 * 0.05 N m on wheels of 0.1 m, and 4 kg that roll with 4 * 0.0025 kg m^2.
  const double force = 4 * 0.05 / 0.1, inertia = 4 + 4 * 0.0025 / 0.01;
  const double way = state.pose.position_m[0] - start;
  EXPECT_NEAR(way, force / inertia * 4 / 2, 0.01);
  EXPECT_NEAR((ReadJoint(*dynamics, 0, AtMs(2200)).position - turned) * 0.1, way, 0.002 * way);
  EXPECT_NEAR(state.pose.position_m[1], 0, 1e-4);
}

// Whether shapes are near each other is looked at in another way where they are many.
TEST_P(ModelsInContact, WhatIsFarAwayChangesNoBit) {
  for (const Geometry& geometry : {Cube(0.2), Geometry{SphereShape{0.1}}}) {
    RobotModel thrown = Loose("thrown", geometry, {{0, 0, 0.5}, FromRollPitchYaw(0.3, 0.2, 0.1)});
    thrown.linear_velocity_mps = {1, 0, 0};
    thrown.angular_velocity_radps = {3, 1, 2};
    WorldSpec world = WorldOf({thrown}, GetParam());
    const Geometry slab = BoxShape{{6, 6, 0.5}};
    world.fixtures = {ShapeOf(slab, 0.8, {{0, 0, -0.25}, {0, 0, 0, 1}})};
    auto alone = MakeDynamics(world);
    for (int i = 0; i < 100; ++i) {
      world.fixtures.push_back(ShapeOf(Cube(0.5), 0.8, {{i - 50.0, 30, 5}, {0, 0, 0, 1}}));
    }
    auto among_others = MakeDynamics(world);
    double lowest_m = 1;
    for (int ms = 0; ms <= 1500; ms += 7) {
      const LinkState state = ReadLink(*alone, 0, AtMs(ms));
      lowest_m = std::min(lowest_m, state.pose.position_m[2]);
      const LinkState same = ReadLink(*among_others, 0, AtMs(ms));
      ASSERT_EQ(std::memcmp(&state, &same, sizeof state), 0) << ms;
    }
    EXPECT_LT(lowest_m, 0.15);
  }
}

TEST_P(ModelsInContact, ModelsThatCollideKeepTheirMomentum) {
  RobotModel left = Loose("left", SphereShape{0.1}, {{-0.5, 0.02, 0}, {0, 0, 0, 1}}, 2);
  RobotModel right = Loose("right", Cube(0.3), {{0.5, 0, 0}, {0, 0, 0, 1}}, 3, 0.8, 0.045);
  left.linear_velocity_mps = {1, 0, 0};
  right.linear_velocity_mps = {-1, 0, 0};
  WorldSpec world = WorldOf({left, right}, GetParam());
  world.gravity_mps2 = {};
  auto dynamics = MakeDynamics(world);
  const int a = *dynamics->FindLink("left", "left"), b = *dynamics->FindLink("right", "right");
  const LinkState after_a = ReadLink(*dynamics, a, AtMs(1000));
  const LinkState after_b = ReadLink(*dynamics, b, AtMs(1000));
  for (std::size_t i = 0; i < 3; ++i) {
    const double momentum = 2 * after_a.linear_velocity_mps[i] + 3 * after_b.linear_velocity_mps[i];
    EXPECT_NEAR(momentum, i == 0 ? -1 : 0, 1e-3);
  }
  EXPECT_LT(after_a.linear_velocity_mps[0], after_b.linear_velocity_mps[0] + 1e-3)
      << "they part, or stay together";
  EXPECT_LT(after_a.linear_velocity_mps[0], 0.5);
  world.models[0].touches_models = false;
  auto apart = MakeDynamics(world);
  EXPECT_EQ(apart->island_count(), 2);
  EXPECT_NEAR(ReadLink(*apart, a, AtMs(1000)).linear_velocity_mps[0], 1, 1e-9);
}

TEST_P(ModelsInContact, AStackOfBoxesStands) {
  WorldSpec world = WorldOf({}, GetParam());
  world.fixtures = {Floor()};
  for (int i = 0; i < 4; ++i) {
    world.models.push_back(Loose("box" + std::to_string(i), Cube(0.2),
                                 {{0, 0, 0.1 + 0.2 * i}, {0, 0, 0, 1}}, 1, 0.8, 1.0 / 150));
  }
  auto dynamics = MakeDynamics(world);
  for (int i = 0; i < 4; ++i) {
    const LinkState state = ReadLink(*dynamics, i, AtMs(3000));
    EXPECT_NEAR(state.pose.position_m[0], 0, 1e-3) << i;
    EXPECT_NEAR(state.pose.position_m[1], 0, 1e-3) << i;
    EXPECT_NEAR(state.pose.position_m[2], 0.1 + 0.2 * i, 2e-3) << i;
  }
}

// An arm over a floor, beside a box that it strikes: commands of all kinds, read ahead of by up to
// 40 ms, so that most of them take something back; checkpoints, and branches from them.
TEST_P(ModelsInContact, AreTakenBackToTheByte) {
  RobotModel arm = Pendulum(2, 0.3, 0.5, 0.01);
  arm.name = "arm";
  arm.at.position_m = {0, 0, 0.75};
  arm.joints[0].limits = {.lower = -1.5, .upper = 1.5, .effort = 20};
  arm.joints[1].friction = 0.01;
  for (std::size_t i = 1; i < 3; ++i) {
    arm.links[i].shapes.push_back(
        ShapeOf(CapsuleShape{0.03, 0.3}, 0.6, {{0, 0, -0.15}, {0, 0, 0, 1}}));
  }
  WorldSpec world =
      WorldOf({arm, Loose("box", Cube(0.2), {{0.3, 0, 0.12}, {0, 0, 0, 1}}, 0.5)}, GetParam());
  world.fixtures = {Floor()};
  auto known = MakeDynamics(world);
  auto leading = MakeDynamics(world);
  std::mt19937_64 random(11);
  const auto draw = [&](std::uint64_t below) {
    return static_cast<std::int64_t>(random() % below);
  };
  struct Timed {
    std::int64_t at_ns;
    int joint;  // or a push on the box
    double value;
  };
  std::vector<Timed> commands;
  std::int64_t at_ns = 0;
  for (int i = 0; i < 1000; ++i) {
    if (draw(5) != 0) at_ns += 1 + draw(8'000'000);
    commands.push_back({at_ns, static_cast<int>(draw(3)), 0.5 * static_cast<double>(draw(9)) - 2});
  }
  const auto apply = [](Dynamics& dynamics, const Timed& command) {
    if (command.joint == 2) {
      dynamics.ApplyToLink(3, command.value < 0 ? WrenchFrame::kWorld : WrenchFrame::kLink,
                           {.force_n = {command.value, 0.2, 0}}, At(command.at_ns));
    } else {
      dynamics.Drive(command.joint, {.stiffness = 5, .position = command.value, .damping = 0.2},
                     At(command.at_ns));
    }
  };
  struct All {
    std::array<LinkState, 4> links;
    std::array<JointState, 2> joints;
  };
  const auto read = [](Dynamics& dynamics, std::int64_t ns) {
    All all;
    dynamics.ReadLinks(At(ns), std::array{0, 1, 2, 3}, all.links);
    dynamics.ReadJoints(At(ns), std::array{0, 1}, all.joints);
    return all;
  };
  ASSERT_NO_FATAL_FAILURE(ExpectTheSameToTheByte(*known, *leading, commands, apply, read, draw));
  const All end = read(*known, commands.back().at_ns);
  EXPECT_GT(std::abs(end.links[3].pose.position_m[0] - 0.3), 0.01) << "the box was struck";
}

}  // namespace
}  // namespace tcs
