// Joints that stiff servos hold: as accurate as without servos, in few steps, and whatever is read
// or taken back meanwhile.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

#include "tests/unit/dynamics/taken_back.h"
#include "tests/unit/dynamics/test_models.h"

namespace tcs {
namespace {

constexpr int kJoints = 6;

// Six joints as an arm has them: 17 kg, of which the last one turns 5e-4 kg m^2.
RobotModel Arm(bool has_fixed_base = true) {
  struct Piece {
    std::array<double, 3> axis, at_m;
    double mass_kg;
    std::array<double, 3> center_m;
    double moment_kgm2, effort_nm, damping_nms;
  };
  constexpr std::array<double, 3> kY{0, 1, 0}, kZ{0, 0, 1};
  const std::array<Piece, kJoints> pieces = {
      Piece{kZ, {0, 0, 0.09}, 3.7, {0, 0.03, 0}, 0.01, 150, 2},
      Piece{kY, {0, 0.13, 0}, 8, {0, 0, 0.2125}, 0.12, 150, 2},
      Piece{kY, {0, -0.12, 0.425}, 2.4, {0, 0, 0.196}, 0.03, 150, 1.5},
      Piece{kY, {0, 0, 0.392}, 1.2, {0, 0.0465, 0}, 0.0016, 28, 0.3},
      Piece{kZ, {0, 0.093, 0}, 1.2, {0, 0, 0.0475}, 0.0016, 28, 0.3},
      Piece{kY, {0, 0, 0.095}, 0.6, {0, 0.1, 0}, 5e-4, 28, 0.02}};
  RobotModel model;
  model.name = "arm";
  model.has_fixed_base = has_fixed_base;
  model.links.push_back(LinkOf("base", MassAt(20, {}, 0.5)));
  for (int i = 0; i < kJoints; ++i) {
    const Piece& piece = pieces[static_cast<std::size_t>(i)];
    const std::string number = std::to_string(i);
    model.links.push_back(
        LinkOf("link" + number, MassAt(piece.mass_kg, piece.center_m, piece.moment_kgm2)));
    Joint joint = JointOf("joint" + number, JointKind::kRevolute, i, i + 1, piece.axis, piece.at_m);
    joint.limits.effort = piece.effort_nm;
    joint.damping = piece.damping_nms;
    joint.initial_position = {0.3 * (i + 1)};
    model.joints.push_back(joint);
  }
  return model;
}

// Half a radian off it gives all that the joint can; the last joint follows within 0.2 ms.
JointDrive ServoOf(const Joint& joint, double position) {
  return {.stiffness = 2 * joint.limits.effort,
          .position = position,
          .damping = 0.1 * joint.limits.effort};
}

// Of one motion, read every millisecond.
using Course = std::vector<std::array<JointState, kJoints>>;

struct Sway {
  int milliseconds = 300;
  double radians = 0.2;  // by which each servo is sent to and fro
  double radps = 5;      // how fast
  VirtualDuration read_each = VirtualDuration::Milliseconds(1);
};

// Every 10 ms, half a millisecond later, six commands.
Course Follow(const WorldSpec& world, const Sway& sway, std::int64_t* steps = nullptr) {
  const auto dynamics = MakeDynamics(world);
  const RobotModel& arm = world.models[0];
  std::array<int, kJoints> joints{};
  std::iota(joints.begin(), joints.end(), 0);
  Course course;
  for (int ms = 0; ms < sway.milliseconds; ++ms) {
    const VirtualTime now = AtMs(ms);
    dynamics->AdvanceTo(now);
    if (now.ns() % sway.read_each.ns() == 0) {
      dynamics->ReadJoints(now, joints, course.emplace_back());
    }
    if (ms % 10 != 0) continue;
    for (const int i : joints) {
      const Joint& joint = arm.joints[static_cast<std::size_t>(i)];
      const double to = joint.initial_position[0] + sway.radians * std::sin(1e-3 * sway.radps * ms);
      dynamics->Drive(i, ServoOf(joint, to), now + VirtualDuration::Microseconds(500));
    }
  }
  if (steps != nullptr) *steps = dynamics->work().steps;
  return course;
}

struct Difference {
  double position = 0, velocity = 0;
};
Difference Between(const Course& a, const Course& b) {
  EXPECT_EQ(a.size(), b.size());
  Difference greatest;
  for (std::size_t k = 0; k < a.size(); ++k) {
    for (std::size_t i = 0; i < kJoints; ++i) {
      greatest.position =
          std::max(greatest.position, std::abs(a[k][i].position - b[k][i].position));
      greatest.velocity =
          std::max(greatest.velocity, std::abs(a[k][i].velocity - b[k][i].velocity));
    }
  }
  return greatest;
}

// The same beside a model of so many speeds that steps become those of Runge-Kutta 3, which are
// explicit: fine enough for the servos, they are a reference of another kind. The balls fall.
WorldSpec FinelyBesideBalls(WorldSpec world) {
  RobotModel balls;
  balls.name = "balls";
  balls.has_fixed_base = true;
  balls.links.push_back({.name = "base", .inertial = {}, .shapes = {}});
  for (int i = 0; i < 7; ++i) {
    const std::string number = std::to_string(i);
    balls.links.push_back(LinkOf("ball" + number, MassAt(1, {}, 0.01)));
    balls.joints.push_back(JointOf("free" + number, JointKind::kFloating, 0, i + 1, {1, 0, 0}));
  }
  world.models.push_back(balls);
  world.models_together = {{0, 1}};
  world.integrator.accuracy = 1e-7;
  return world;
}

TEST(Servos, MoveAnArmAsFineStepsDo) {
  const WorldSpec world = WorldOf({Arm()}, {});
  const Sway sway{};
  const Difference off = Between(Follow(world, sway), Follow(FinelyBesideBalls(world), sway));
  EXPECT_LT(off.position, 1e-5);
  EXPECT_LT(off.velocity, 1e-3);
}

// Most commands ask for more than the joints can give.
TEST(Servos, MoveAnArmAsFineStepsDoAtTheLimitsOfTheirEffort) {
  WorldSpec world = WorldOf({Arm()}, {});
  for (Joint& joint : world.models[0].joints) joint.limits.effort /= 3;
  const Sway sway{.radians = 1.5, .radps = 20};
  const Course course = Follow(world, sway);
  int limited = 0;
  for (const auto& joints : course) {
    for (std::size_t i = 0; i < kJoints; ++i) {
      limited += std::abs(joints[i].effort) == world.models[0].joints[i].limits.effort ? 1 : 0;
    }
  }
  EXPECT_GT(limited, 20);
  EXPECT_LT(limited, kJoints * static_cast<int>(course.size()) - 20);
  const Difference off = Between(course, Follow(FinelyBesideBalls(world), sway));
  EXPECT_LT(off.position, 1e-4);
}

TEST(Servos, MoveAnArmAsFineStepsDoWhereTheyLag) {
  WorldSpec world = WorldOf({Arm()}, {});
  for (Joint& joint : world.models[0].joints) {
    joint.drive_lag = VirtualDuration::Milliseconds(15);
    joint.friction = 0.05;
  }
  const Sway sway{};
  const Difference off = Between(Follow(world, sway), Follow(FinelyBesideBalls(world), sway));
  EXPECT_LT(off.position, 2e-5);
}

TEST(Servos, MoveAnArmAsFineStepsDoOnABaseThatTurnsFreely) {
  WorldSpec world = WorldOf({Arm(false)}, {});
  world.models[0].angular_velocity_radps = {0.5, -1, 2};
  world.gravity_mps2 = {};
  const Sway sway{};
  const auto pose_of_tool = [&](const WorldSpec& of) {
    const auto dynamics = MakeDynamics(of);
    for (int i = 0; i < kJoints; ++i) {
      const Joint& joint = of.models[0].joints[static_cast<std::size_t>(i)];
      dynamics->Drive(i, ServoOf(joint, joint.initial_position[0] + 0.2), AtMs(1));
    }
    // Within a step, and at the end of others.
    (void)ReadLink(*dynamics, kJoints, AtMs(123));
    return ReadLink(*dynamics, kJoints, AtMs(300)).pose;
  };
  const Pose ours = pose_of_tool(world), fine = pose_of_tool(FinelyBesideBalls(world));
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(ours.position_m[k], fine.position_m[k], 1e-5);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(ours.orientation_xyzw[k], fine.orientation_xyzw[k], 1e-5);
  }
  const Difference off = Between(Follow(world, sway), Follow(FinelyBesideBalls(world), sway));
  EXPECT_LT(off.position, 1e-5);
}

TEST(Servos, MoveAnArmAsFineStepsDoWhereAJointMimicsAnother) {
  WorldSpec world = WorldOf({Arm()}, {});
  Joint& mimic = world.models[0].joints[5];
  mimic.mimic = Mimic{3, -0.5, 0.2};
  mimic.initial_position.clear();
  const auto angles_of = [](const WorldSpec& of) {
    const auto dynamics = MakeDynamics(of);
    for (int i = 0; i < kJoints - 1; ++i) {
      const Joint& joint = of.models[0].joints[static_cast<std::size_t>(i)];
      dynamics->Drive(i, ServoOf(joint, joint.initial_position[0] + 0.2), AtMs(1));
    }
    return std::array{
        ReadJoint(*dynamics, 3, AtMs(57)).position, ReadJoint(*dynamics, 5, AtMs(57)).position,
        ReadJoint(*dynamics, 3, AtMs(300)).position, ReadJoint(*dynamics, 5, AtMs(300)).position};
  };
  const auto ours = angles_of(world), fine = angles_of(FinelyBesideBalls(world));
  for (std::size_t i = 0; i < ours.size(); ++i) EXPECT_NEAR(ours[i], fine[i], 1e-5) << i;
  EXPECT_NEAR(ours[3], -0.5 * ours[2] + 0.2, 1e-12);
}

// A wheel that is much lighter than its servo is strong: the lag is 0.1 ms.
TEST(Servos, OfAnyStiffnessReachTheirSpeedInClosedForm) {
  constexpr double kMoment = 1e-4, kDamping = 1, kSpeed = 10;
  RobotModel wheel = Pendulum(1, 0, 1, kMoment);
  wheel.joints[0].kind = JointKind::kContinuous;
  const auto dynamics = MakeDynamics(WorldOf({wheel}, {}));
  dynamics->Drive(0, {.damping = kDamping, .velocity = kSpeed}, AtMs(5));
  constexpr double kLagS = kMoment / kDamping;
  for (const double t : {0.0, 0.3e-4, 1e-4, 2e-4, 1e-3, 0.02, 1.0}) {
    const JointState state =
        ReadJoint(*dynamics, 0, AtMs(5) + VirtualDuration::Nanoseconds(std::llround(t * 1e9)));
    const double share = -std::expm1(-t / kLagS);
    EXPECT_NEAR(state.velocity, kSpeed * share, 1e-8) << t;
    EXPECT_NEAR(state.position, kSpeed * (t - kLagS * share), 1e-10) << t;
  }
  EXPECT_LT(dynamics->work().steps, 10);
}

// The reads in between are of a finer course, which is no other one.
TEST(Servos, AnArmMovesTheSameToTheByteHoweverOftenItIsRead) {
  const WorldSpec world = WorldOf({Arm()}, {});
  const Course often = Follow(world, {});
  const Course seldom = Follow(world, {.read_each = VirtualDuration::Milliseconds(50)});
  for (std::size_t k = 0; k < seldom.size(); ++k) {
    EXPECT_EQ(std::memcmp(&seldom[k], &often[50 * k], sizeof seldom[k]), 0) << k;
  }
}

// By an explicit method it is 40 of them.
TEST(Servos, CostAnArmFewStepsForEachCommand) {
  std::int64_t steps = 0;
  const Sway sway{.milliseconds = 1000, .read_each = VirtualDuration::Milliseconds(10)};
  (void)Follow(WorldOf({Arm()}, {}), sway, &steps);
  const int commands = sway.milliseconds / 10;
  EXPECT_LT(steps, 10 * commands);
  EXPECT_GE(steps, commands);
}

// The servo of the wrist is strong beside its inertia: the wrist follows what pushes it at once,
// and what pushes it grows as the arm moves. That is no error of a step.
TEST(Servos, ThatAreStiffBeyondTheStepsKeepThemNoShorter) {
  WorldSpec world = WorldOf({Arm()}, {});
  world.models[0].links[kJoints].inertial = MassAt(0.1, {0, 0.05, 0}, 2e-5);
  std::int64_t steps = 0;
  const Sway sway{.milliseconds = 1000, .read_each = VirtualDuration::Milliseconds(10)};
  (void)Follow(world, sway, &steps);
  EXPECT_LT(steps, 400);  // 706 where the growth counted as one
}

// A servo that is sent to and fro asks for up to thrice what its joint can give. Where that begins
// and ends is a kink, at which steps end.
TEST(Servos, CostFewStepsAtTheLimitsOfTheirEffort) {
  RobotModel wheel = Pendulum(1, 0, 1, 1e-4);
  wheel.joints[0].kind = JointKind::kContinuous;
  wheel.joints[0].limits.effort = 1;
  const auto dynamics = MakeDynamics(WorldOf({wheel}, {}));
  constexpr int kCommands = 50;
  int limited = 0;
  for (int i = 0; i < kCommands; ++i) {
    const double to = i % 2 == 0 ? 0.3 : -0.3;
    dynamics->Drive(0, {.stiffness = 5, .position = to, .damping = 0.2}, AtMs(20 * i));
    for (int ms = 0; ms < 20; ++ms) {
      const double effort = ReadJoint(*dynamics, 0, AtMs(20 * i + ms)).effort;
      limited += std::abs(effort) == 1 ? 1 : 0;
    }
  }
  EXPECT_GT(limited, kCommands / 2);
  EXPECT_LT(limited, 10 * kCommands);
  EXPECT_LT(dynamics->work().steps, 200);  // 618 where error control alone looks for the kinks
}

TEST(Servos, WithStepsOfASetLengthAreStableBeyondTheirLag) {
  IntegratorSpec spec;
  spec.fixed_step = VirtualDuration::Milliseconds(2);
  const WorldSpec fixed = WorldOf({Arm()}, spec), free = WorldOf({Arm()}, {});
  EXPECT_LT(Between(Follow(fixed, {}), Follow(free, {})).position, 1e-4);
}

TEST(Servos, AreTakenBackToTheByte) {
  WorldSpec world = WorldOf({Arm()}, {});
  world.models[0].joints[2].drive_lag = VirtualDuration::Milliseconds(8);
  std::mt19937_64 random(5);
  const auto draw = [&](std::int64_t below) {
    return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(below));
  };
  struct Timed {
    std::int64_t at_ns;
    int joint;
    double value;
    bool is_servo;
  };
  std::vector<Timed> commands;
  std::int64_t at_ns = 0;
  for (int i = 0; i < 600; ++i) {
    if (draw(5) != 0) at_ns += 1 + draw(6'000'000);
    commands.push_back({at_ns, static_cast<int>(draw(kJoints)),
                        1e-3 * static_cast<double>(draw(1000)), draw(10) != 0});
  }
  const auto apply = [&](Dynamics& dynamics, const Timed& command) {
    const Joint& joint = world.models[0].joints[static_cast<std::size_t>(command.joint)];
    const JointDrive drive =
        command.is_servo ? ServoOf(joint, command.value) : JointDrive{.effort = command.value};
    dynamics.Drive(command.joint, drive, At(command.at_ns));
  };
  const auto read = [](Dynamics& dynamics, std::int64_t ns) {
    std::array<JointState, kJoints> states;
    std::array<int, kJoints> joints{};
    std::iota(joints.begin(), joints.end(), 0);
    dynamics.ReadJoints(At(ns), joints, states);
    return states;
  };
  const auto known = MakeDynamics(world), leading = MakeDynamics(world);
  ASSERT_NO_FATAL_FAILURE(ExpectTheSameToTheByte(*known, *leading, commands, apply, read, draw));
}

}  // namespace
}  // namespace tcs
