// Models without contact, against closed forms.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "simbody_bridge/model/rigid_tree.h"
#include "tests/unit/dynamics/test_models.h"

namespace tcs {
namespace {

class ModelsInMotion : public EveryModelEngine {};

INSTANTIATE_TEST_SUITE_P(Engines, ModelsInMotion, testing::ValuesIn(ModelEngines()), NameOfEngine);

// Of a pendulum with moment `inertia` about its hinge and `torque` = m g l, that starts at rest at
// `angle`: 4 sqrt(I / mgl) K(sin(angle / 2)), by the arithmetic-geometric mean.
double PeriodOf(double inertia, double torque, double angle) {
  double a = 1, b = std::cos(angle / 2);
  for (int i = 0; i < 20; ++i) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return 2 * kPi * std::sqrt(inertia / torque) / a;
}

TEST_P(ModelsInMotion, APendulumKeepsItsPeriod) {
  for (const double angle : {0.1, 1.0, 2.5}) {
    RobotModel model = Pendulum(1);
    model.joints[0].initial_position = {angle};
    IntegratorSpec spec = GetParam();
    spec.accuracy = 1e-7;
    auto dynamics = MakeDynamics(WorldOf({model}, spec));
    // It turns back after whole periods: its velocity passes through 0 downwards in between.
    const double period_s = PeriodOf(1.01, kG, angle);
    const auto velocity_at = [&](double seconds) {
      const auto t = VirtualTime::FromNanoseconds(std::llround(seconds * 1e9));
      dynamics->AdvanceTo(t);
      return ReadJoint(*dynamics, 0, t).velocity;
    };
    constexpr int kPeriods = 5;
    const double before_s = kPeriods * period_s * (1 - 1e-4),
                 after_s = kPeriods * period_s * (1 + 1e-4);
    const double before = velocity_at(before_s), after = velocity_at(after_s);
    ASSERT_GT(before, 0);
    ASSERT_LT(after, 0);
    const double measured_s = before_s + (after_s - before_s) * before / (before - after);
    EXPECT_NEAR(measured_s / kPeriods, period_s, 1e-5 * period_s) << "from " << angle << " rad";
  }
}

double EnergyOfDoublePendulum(Dynamics& dynamics, VirtualTime t) {
  double energy = 0;
  for (const int link : {1, 2}) {
    const LinkState state = ReadLink(dynamics, link, t);
    const std::array<double, 3> arm = Rotate(state.pose.orientation_xyzw, {0, 0, -1});
    const auto& w = state.angular_velocity_radps;
    const auto& v = state.linear_velocity_mps;
    const std::array<double, 3> speed = {v[0] + w[1] * arm[2] - w[2] * arm[1],
                                         v[1] + w[2] * arm[0] - w[0] * arm[2],
                                         v[2] + w[0] * arm[1] - w[1] * arm[0]};
    for (std::size_t i = 0; i < 3; ++i) energy += speed[i] * speed[i] / 2 + 0.01 * w[i] * w[i] / 2;
    energy += kG * (state.pose.position_m[2] + arm[2]);
  }
  return energy;
}

TEST_P(ModelsInMotion, ADoublePendulumKeepsItsEnergy) {
  RobotModel model = Pendulum(2);
  model.joints[0].initial_position = {2.0};
  model.joints[1].initial_position = {1.0};
  IntegratorSpec spec = GetParam();
  spec.accuracy = 1e-7;
  auto dynamics = MakeDynamics(WorldOf({model}, spec));
  const double start = EnergyOfDoublePendulum(*dynamics, AtMs(0));
  double least_angle = 10, greatest_angle = -10;
  for (int ms = 0; ms <= 10'000; ms += 50) {
    dynamics->AdvanceTo(AtMs(ms));
    ASSERT_NEAR(EnergyOfDoublePendulum(*dynamics, AtMs(ms)), start, 1e-4 * std::abs(start))
        << "at " << ms << " ms";
    const double angle = ReadJoint(*dynamics, 0, AtMs(ms)).position;
    least_angle = std::min(least_angle, angle);
    greatest_angle = std::max(greatest_angle, angle);
  }
  EXPECT_GT(greatest_angle - least_angle, 2) << "it hardly moved";
}

// A base that floats in free fall, turning as a free body does.
TEST_P(ModelsInMotion, AFreeBaseFallsAndTurns) {
  RobotModel model;
  model.name = "stone";
  model.links.push_back(LinkOf("stone", MassAt(2, {0.1, 0, 0}, 0.05)));
  model.at = {{0, 0, 5}, {0, 0, std::sin(0.5), std::cos(0.5)}};
  model.linear_velocity_mps = {1, 2, 3};
  model.angular_velocity_radps = {0, 0, 3};
  auto dynamics = MakeDynamics(WorldOf({model}, GetParam()));
  const LinkState start = ReadLink(*dynamics, 0, AtMs(0));
  EXPECT_NEAR(start.linear_velocity_mps[1], 2, 1e-12);
  EXPECT_NEAR(start.angular_velocity_radps[2], 3, 1e-12);
  const LinkState state = ReadLink(*dynamics, 0, AtMs(500));
  // The center of mass moves as a stone; the origin circles it.
  const double from = 1.0, to = from + 3 * 0.5;
  const double vx = 1 - 3 * 0.1 * std::sin(from), vy = 2 + 3 * 0.1 * std::cos(from);
  EXPECT_NEAR(state.pose.position_m[0], 0.1 * std::cos(from) + vx * 0.5 - 0.1 * std::cos(to), 1e-4);
  EXPECT_NEAR(state.pose.position_m[1], 0.1 * std::sin(from) + vy * 0.5 - 0.1 * std::sin(to), 1e-4);
  EXPECT_NEAR(state.pose.position_m[2], 5 + 3 * 0.5 - kG * 0.125, 1e-9);
  EXPECT_NEAR(state.pose.orientation_xyzw[2], std::sin(to / 2), 1e-4);
  EXPECT_NEAR(state.angular_velocity_radps[2], 3, 1e-9);
}

TEST_P(ModelsInMotion, AnEffortActsFromItsInstantOn) {
  RobotModel model = Pendulum(1);
  WorldSpec world = WorldOf({model}, GetParam());
  world.gravity_mps2 = {};
  auto dynamics = MakeDynamics(world);
  const int hinge = *dynamics->FindJoint("pendulum", "hinge1");
  dynamics->Drive(hinge, {.effort = 2.02}, At(123'456'789));
  EXPECT_EQ(ReadJoint(*dynamics, hinge, At(123'456'789)).effort, 0);
  const JointState state = ReadJoint(*dynamics, hinge, At(623'456'789));
  EXPECT_NEAR(state.position, 2 * 0.25 / 2, 1e-9);
  EXPECT_NEAR(state.velocity, 2 * 0.5, 1e-9);
  EXPECT_EQ(state.effort, 2.02);
}

TEST_P(ModelsInMotion, AJointTakesNoMoreEffortThanItsLimit) {
  RobotModel model = Pendulum(1);
  model.joints[0].limits.effort = 1.01;
  WorldSpec world = WorldOf({model}, GetParam());
  world.gravity_mps2 = {};
  auto dynamics = MakeDynamics(world);
  dynamics->Drive(0, {.effort = -50}, AtMs(0));
  const JointState state = ReadJoint(*dynamics, 0, AtMs(1000));
  EXPECT_NEAR(state.velocity, -1, 1e-9);
  EXPECT_EQ(state.effort, -1.01);
}

// A servo of natural frequency w and damping ratio 0.5 on a moment I: the step response.
TEST_P(ModelsInMotion, AServosStepResponseIsTheClosedForm) {
  WorldSpec world = WorldOf({Pendulum(1)}, GetParam());
  world.gravity_mps2 = {};
  world.integrator.accuracy = 1e-7;
  auto dynamics = MakeDynamics(world);
  constexpr double kInertia = 1.01, kRate = 20, kRatio = 0.5;
  dynamics->Drive(0,
                  {.stiffness = kInertia * kRate * kRate,
                   .position = 0.5,
                   .damping = 2 * kRatio * kRate * kInertia},
                  AtMs(10));
  const double damped = kRate * std::sqrt(1 - kRatio * kRatio);
  for (int ms = 10; ms <= 500; ms += 7) {
    const double t = 1e-3 * (ms - 10);
    const double expected =
        0.5 * (1 - std::exp(-kRatio * kRate * t) *
                       (std::cos(damped * t) + kRatio * kRate / damped * std::sin(damped * t)));
    ASSERT_NEAR(ReadJoint(*dynamics, 0, AtMs(ms)).position, expected, 2e-5) << ms;
  }
}

TEST_P(ModelsInMotion, DampingAndFrictionSlowAJointDown) {
  RobotModel model = Pendulum(1);
  model.joints[0].initial_velocity = {2};
  WorldSpec world = WorldOf({model}, GetParam());
  world.gravity_mps2 = {};
  world.models[0].joints[0].damping = 1.01;
  EXPECT_NEAR(ReadJoint(*MakeDynamics(world), 0, AtMs(1000)).velocity, 2 * std::exp(-1.0), 1e-4);
  world.models[0].joints[0].damping = 0;
  world.models[0].joints[0].friction = 1.01;
  auto rubbing = MakeDynamics(world);
  EXPECT_NEAR(ReadJoint(*rubbing, 0, AtMs(1000)).velocity, 1, 2e-3);
  EXPECT_NEAR(ReadJoint(*rubbing, 0, AtMs(3000)).velocity, 0, 1e-3);
}

TEST_P(ModelsInMotion, AJointStopsAtItsLimits) {
  RobotModel model = Pendulum(1);
  model.joints[0].limits = {.lower = -0.5, .upper = 0.7};
  model.joints[0].initial_velocity = {2};
  WorldSpec world = WorldOf({model}, GetParam());
  world.gravity_mps2 = {};
  auto dynamics = MakeDynamics(world);
  double most = 0;
  for (int ms = 0; ms <= 1000; ms += 1) {
    most = std::max(most, ReadJoint(*dynamics, 0, AtMs(ms)).position);
  }
  EXPECT_NEAR(most, 0.7, 5e-3) << "it reaches the stop and does not pass it";
  dynamics->Drive(0, {.effort = -5}, AtMs(1000));
  EXPECT_NEAR(ReadJoint(*dynamics, 0, AtMs(4000)).position, -0.5, 1e-3);
}

TEST_P(ModelsInMotion, AMimicFollowsItsLeader) {
  RobotModel model = Pendulum(2);
  model.joints[0].initial_position = {1};
  model.joints[1].mimic = Mimic{0, -0.5, 0.2};
  auto dynamics = MakeDynamics(WorldOf({model}, GetParam()));
  bool has_moved = false;
  for (int ms = 0; ms <= 2000; ms += 20) {
    const std::array joints = {0, 1};
    std::array<JointState, 2> states;
    dynamics->ReadJoints(AtMs(ms), joints, states);
    ASSERT_NEAR(states[1].position, -0.5 * states[0].position + 0.2, 2e-3) << ms;
    has_moved = has_moved || states[0].position < -0.3;
  }
  EXPECT_TRUE(has_moved);
}

// Along and about the axis (1, 1, 0) / sqrt(2), from a frame that is turned and moved.
TEST_P(ModelsInMotion, JointsMoveTheirChildrenAsUrdfMeansIt) {
  const double half = std::numbers::sqrt2 / 2;
  for (const JointKind kind :
       {JointKind::kPrismatic, JointKind::kRevolute, JointKind::kContinuous, JointKind::kPlanar}) {
    RobotModel model;
    model.name = "m";
    model.has_fixed_base = true;
    model.links.push_back({.name = "base", .inertial = {}, .shapes = {}});
    model.links.push_back(LinkOf("child", MassAt(1, {}, 0.1)));
    Joint joint = JointOf("j", kind, 0, 1, {3, 3, 0}, {1, 2, 3});
    joint.origin.orientation_xyzw = {0, 0, half, half};  // x to y, y to -x
    joint.initial_position =
        kind == JointKind::kPlanar ? std::vector{0.3, 0.4, 0.5} : std::vector{0.25};
    model.joints.push_back(joint);
    auto dynamics = MakeDynamics(WorldOf({model}, GetParam()));
    const LinkState state = ReadLink(*dynamics, 1, AtMs(0));
    const std::array<double, 3> axis = {-half, half, 0};  // in the world
    const auto& p = state.pose.position_m;
    const auto turned = Rotate(state.pose.orientation_xyzw, {half, half, 0});
    for (std::size_t i = 0; i < 3; ++i) ASSERT_NEAR(turned[i], axis[i], 1e-12) << "the axis stays";
    if (kind == JointKind::kPrismatic) {
      EXPECT_NEAR(p[0], 1 - 0.25 * half, 1e-12);
      EXPECT_NEAR(p[1], 2 + 0.25 * half, 1e-12);
    } else if (kind == JointKind::kPlanar) {
      // In the joint's frame: z goes to (1, 1, 0) / sqrt(2), x to (1, -1, -sqrt(2)) / 2 and so on.
      const Pose frame = Times(joint.origin, Pose{{}, FromZTo({half, half, 0})});
      const auto at = Times(frame, Pose{{0.3, 0.4, 0}, {0, 0, std::sin(0.25), std::cos(0.25)}});
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(p[i], at.position_m[i], 1e-12);
      const auto x =
          Rotate(state.pose.orientation_xyzw, Rotate(FromZTo({half, half, 0}), {1, 0, 0}));
      const auto x_meant = Rotate(at.orientation_xyzw, {1, 0, 0});
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(x[i], x_meant[i], 1e-12);
    } else {
      EXPECT_NEAR(p[0], 1, 1e-12);
      const auto z = Rotate(state.pose.orientation_xyzw, {0, 0, 1});
      EXPECT_NEAR(z[2], std::cos(0.25), 1e-12);
      // Right-handed about (-1, 1, 0): z goes towards (1, 1, 0).
      EXPECT_NEAR(z[0], std::sin(0.25) * half, 1e-12);
    }
  }
}

// Links that are fixed to each other have the mass of all, wherever each of them is.
TEST_P(ModelsInMotion, FixedLinksAreOneBody) {
  RobotModel whole = Pendulum(1, 1, 2, 0.03);
  whole.joints[0].initial_position = {1};
  RobotModel parts = Pendulum(1);
  parts.joints[0].initial_position = {1};
  parts.links[1].inertial = MassAt(1, {0, 0, -0.9}, 0.01);
  // The other half is 0.1 m further down, in a frame that is turned and moved. Both together have
  // 0.02 kg m^2 about their center by their distance from it.
  parts.links.push_back(LinkOf("half", MassAt(1, {1.1, 0, 0}, 0.01)));
  Joint fixed = JointOf("weld", JointKind::kFixed, 1, 2, {1, 0, 0}, {0.2, 0, 0});
  fixed.origin.orientation_xyzw = FromRollPitchYaw(0, kPi / 2, 0);  // x to -z
  fixed.origin.position_m = {0, 0, 0};
  parts.joints.push_back(fixed);
  whole.links[1].inertial->ixx_kgm2 = whole.links[1].inertial->iyy_kgm2 = 0.04;
  auto one = MakeDynamics(WorldOf({whole}, GetParam()));
  auto two = MakeDynamics(WorldOf({parts}, GetParam()));
  const LinkState half = ReadLink(*two, 2, AtMs(700));
  EXPECT_NEAR(ReadJoint(*one, 0, AtMs(700)).position, ReadJoint(*two, 0, AtMs(700)).position, 1e-9);
  const auto center = Times(half.pose, Pose{{1.1, 0, 0}, {0, 0, 0, 1}}).position_m;
  const double angle = ReadJoint(*two, 0, AtMs(700)).position;
  EXPECT_NEAR(center[0], -1.1 * std::sin(angle), 1e-9);
  EXPECT_NEAR(center[2], -1.1 * std::cos(angle), 1e-9);
}

// A rotor: the force turns with the link.
TEST_P(ModelsInMotion, AWrenchAlongTheLinksAxesTurnsWithIt) {
  RobotModel model;
  model.name = "disc";
  model.links.push_back(LinkOf("disc", MassAt(1, {}, 0.1)));
  model.angular_velocity_radps = {0, 0, kPi / 2};
  WorldSpec world = WorldOf({model}, GetParam());
  world.gravity_mps2 = {};
  world.integrator.accuracy = 1e-7;
  auto dynamics = MakeDynamics(world);
  const int disc = *dynamics->FindLink("disc", "disc");
  dynamics->ApplyToLink(disc, WrenchFrame::kLink, {.force_n = {1, 0, 0}}, AtMs(0));
  dynamics->ApplyToLink(disc, WrenchFrame::kWorld, {.force_n = {0, 0, 2}}, AtMs(0));
  const LinkState state = ReadLink(*dynamics, disc, AtMs(2000));
  EXPECT_NEAR(state.linear_velocity_mps[0], 0, 1e-5) << "half a turn there, half a turn back";
  EXPECT_NEAR(state.linear_velocity_mps[1], 2 / (kPi / 2), 1e-5);
  EXPECT_NEAR(state.linear_velocity_mps[2], 4, 1e-9);
}

TEST(Models, AreRefusedByAnEngineOfFreeBodies) {
  try {
    MakeDynamics(WorldOf({Pendulum(1)}, kOde));
    FAIL() << "ODE took a pendulum";
  } catch (const DynamicsError& error) {
    EXPECT_STREQ(error.what(),
                 "model 'pendulum': the engine ode moves free bodies only, without joints and "
                 "contact; take simbody or mujoco");
  }
}

TEST(Models, ThatAreWrongAreRefusedByName) {
  RobotModel model = Pendulum(1);
  model.links[1].inertial.reset();
  try {
    MakeDynamics(WorldOf({model}, {}));
    FAIL();
  } catch (const DynamicsError& error) {
    EXPECT_STREQ(error.what(),
                 "model 'pendulum': link 'rod1' moves (joint 'hinge1' moves it) but has no mass: "
                 "give it an inertial");
  }
}

}  // namespace
}  // namespace tcs
