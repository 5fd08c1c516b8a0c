// Commands in the body's frame, commands that lag, and the air: against closed forms, with each way
// of taking steps.
#include <algorithm>
#include <cmath>

#include "tests/unit/dynamics/random_commands.h"
#include "tests/unit/dynamics/test_worlds.h"

namespace tcs {
namespace {

constexpr VirtualDuration kCommandLag = VirtualDuration::Milliseconds(50);
constexpr double kCommandLagS = 0.05;

// Steps that are taken here, Simbody's own with error control and of a set length, and ODE's.
std::vector<IntegratorSpec> EveryPath() {
  return {{.accuracy = 1e-9},
          {.kind = IntegratorKind::kRungeKuttaMerson, .fixed_step = {}, .accuracy = 1e-9},
          {.kind = IntegratorKind::kRungeKutta3, .fixed_step = VirtualDuration::Microseconds(700)},
          kOde};
}

class LoadsOfEveryPath : public EveryIntegrator {
 protected:
  static bool IsOde() { return GetParam().engine == EngineKind::kOde; }
  // How near to a closed form; ODE is of first order, with steps of 1 ms.
  static double Near(double ode) { return IsOde() ? ode : 1e-6; }
};

INSTANTIATE_TEST_SUITE_P(Dynamics, LoadsOfEveryPath, testing::ValuesIn(EveryPath()), NameOfParam);

Wrench Push(double newtons) { return {.force_n = {newtons, 0, 0}, .torque_nm = {}}; }
Wrench BodyPush(double newtons) {
  return {.force_n = {newtons, 0, 0}, .torque_nm = {}, .in_body_frame = true};
}
Wrench SlowPush(double newtons) {
  return {.force_n = {newtons, 0, 0}, .torque_nm = {}, .lag = kCommandLag};
}

TEST_P(LoadsOfEveryPath, AThrustInTheBodysFrameTurnsWithTheBody) {
  constexpr double kSpin = 5, kThrust = 3, kA = kThrust / kMass;
  WorldSpec world = OneBody(GetParam());
  world.bodies[0].initial.angular_velocity_radps = {0, 0, kSpin};
  auto dynamics = MakeDynamics(world);
  dynamics->Apply(0, BodyPush(kThrust), At(0));
  for (int ms = 10; ms <= 2000; ms += 10) {
    dynamics->AdvanceTo(AtMs(ms));
    const BodyState state = dynamics->Read(0);
    const double t = 1e-3 * ms, angle = kSpin * t;
    ASSERT_NEAR(state.linear_velocity_mps[0], kA / kSpin * std::sin(angle), Near(3e-3)) << t;
    ASSERT_NEAR(state.linear_velocity_mps[1], kA / kSpin * (1 - std::cos(angle)), Near(3e-3));
    ASSERT_NEAR(state.position_m[0], kA / kSpin / kSpin * (1 - std::cos(angle)), Near(3e-3));
    ASSERT_NEAR(state.position_m[1], kA / kSpin / kSpin * (angle - std::sin(angle)), Near(3e-3));
  }
}

TEST_P(LoadsOfEveryPath, ATorqueInTheBodysFrameTurnsAboutTheBodysAxis) {
  WorldSpec world = OneBody(GetParam());
  const double r =
      std::sqrt(0.5);  // a quarter about z: the body's y axis lies along the world's -x
  world.bodies[0].initial.orientation_xyzw = {0, 0, r, r};
  auto dynamics = MakeDynamics(world);
  dynamics->Apply(0, {.force_n = {}, .torque_nm = {0, 0.4, 0}, .in_body_frame = true},
                  At(123'456'789));
  dynamics->AdvanceTo(At(1'123'456'789));
  const BodyState state = dynamics->Read(0);
  EXPECT_NEAR(state.angular_velocity_radps[0], -0.4 / 0.2, 1e-9);
  EXPECT_NEAR(state.angular_velocity_radps[1], 0, 1e-9);
  EXPECT_NEAR(state.angular_velocity_radps[2], 0, 1e-9);
}

TEST_P(LoadsOfEveryPath, ACommandInTheOtherFrameReplacesTheOneBefore) {
  WorldSpec world = OneBody(GetParam());
  world.bodies[0].initial.orientation_xyzw = {0, 0, 1, 0};  // turned about
  auto dynamics = MakeDynamics(world);
  dynamics->Apply(0, BodyPush(3), At(0));
  dynamics->Apply(0, Push(3), AtMs(100));
  dynamics->AdvanceTo(AtMs(100));
  EXPECT_NEAR(dynamics->Read(0).linear_velocity_mps[0], -3 / kMass * 0.1, 1e-12);
  dynamics->AdvanceTo(AtMs(300));
  EXPECT_NEAR(dynamics->Read(0).linear_velocity_mps[0], 3 / kMass * 0.1, 1e-12);
}

// Of a body that a command with a lag pushes from rest, from time 0 on.
double LaggingVelocity(double newtons, double t) {
  return newtons / kMass * (t + kCommandLagS * std::expm1(-t / kCommandLagS));
}
double LaggingPosition(double newtons, double t) {
  return newtons / kMass *
         (t * t / 2 - kCommandLagS * t -
          kCommandLagS * kCommandLagS * std::expm1(-t / kCommandLagS));
}

TEST_P(LoadsOfEveryPath, ACommandThatLagsComesNearExponentially) {
  auto dynamics = MakeDynamics(OneBody(GetParam()));
  constexpr std::int64_t kAtNs = 12'345'678;
  dynamics->Apply(0, SlowPush(4), At(kAtNs));
  for (int ms = 1; ms <= 1000; ++ms) {
    dynamics->AdvanceTo(AtMs(ms));
    const BodyState state = dynamics->Read(0);
    const double t = std::max(0.0, 1e-3 * ms - 1e-9 * kAtNs);
    // What ODE is given is the mean over its steps: exact at their ends.
    ASSERT_NEAR(state.linear_velocity_mps[0], LaggingVelocity(4, t), IsOde() ? 1e-12 : 1e-7) << t;
    ASSERT_NEAR(state.position_m[0], LaggingPosition(4, t), Near(1.1e-3));
  }
}

// It goes from what acts, wherever that is on its way, and in whichever frame.
TEST_P(LoadsOfEveryPath, ACommandThatLagsBeginsWithWhatActs) {
  WorldSpec world = OneBody(GetParam());
  world.bodies[0].initial.orientation_xyzw = {0, 0, 1, 0};  // turned about
  auto dynamics = MakeDynamics(world);
  Wrench back = SlowPush(6);
  back.in_body_frame = true;  // -6 N along the world's x
  dynamics->Apply(0, SlowPush(4), At(0));
  dynamics->Apply(0, back, AtMs(40));
  dynamics->Apply(0, Push(1), AtMs(100));
  const double at_40 = 4 * -std::expm1(-0.04 / kCommandLagS), v_40 = LaggingVelocity(4, 0.04);
  const auto after_40 = [&](double t) {  // -6 + (at_40 + 6) e^(-t / lag), added up
    return v_40 + (-6 * t - (at_40 + 6) * kCommandLagS * std::expm1(-t / kCommandLagS)) / kMass;
  };
  for (int ms = 1; ms <= 100; ++ms) {
    dynamics->AdvanceTo(AtMs(ms));
    const double v = ms <= 40 ? LaggingVelocity(4, 1e-3 * ms) : after_40(1e-3 * (ms - 40));
    ASSERT_NEAR(dynamics->Read(0).linear_velocity_mps[0], v, IsOde() ? 1e-12 : 1e-7) << ms;
  }
  dynamics->AdvanceTo(AtMs(300));
  EXPECT_NEAR(dynamics->Read(0).linear_velocity_mps[0], after_40(0.06) + 1 / kMass * 0.2, 1e-7)
      << "one without a lag acts at once";
}

// One system has one clock: what changes for one body begins a step of all.
TEST_P(LoadsOfEveryPath, ACommandThatLagsGoesOnWhileOthersOfItsIslandAreCommanded) {
  WorldSpec world = OneBody(GetParam());
  world.bodies.push_back(world.bodies[0]);
  world.together = {{0, 1}};
  auto dynamics = MakeDynamics(world);
  dynamics->Apply(0, SlowPush(4), At(0));
  for (int ms = 7; ms <= 3000; ms += 7) {
    dynamics->Apply(1, ms < 2500 ? Push(ms % 3) : SlowPush(ms % 3), AtMs(ms));
  }
  for (int ms = 1; ms <= 3000; ++ms) {
    dynamics->AdvanceTo(AtMs(ms));
    ASSERT_NEAR(dynamics->Read(0).linear_velocity_mps[0], LaggingVelocity(4, 1e-3 * ms),
                IsOde() ? 1e-11 : 1e-6)
        << ms;
  }
}

TEST_P(LoadsOfEveryPath, ACommandThatLagsCostsNothingOnceItHasSettled) {
  auto repeated = MakeDynamics(OneBody(GetParam()));
  auto once = MakeDynamics(OneBody(GetParam()));
  once->Apply(0, SlowPush(4), AtMs(5));
  for (int ms = 5; ms <= 3000; ms += 5) {
    repeated->Apply(0, SlowPush(4), AtMs(ms));
    repeated->AdvanceTo(AtMs(ms));
    once->AdvanceTo(AtMs(ms));
    ASSERT_TRUE(SameBits(repeated->Read(0), once->Read(0))) << "at " << ms << " ms";
  }
  EXPECT_EQ(repeated->work().changes, 1);
  EXPECT_EQ(repeated->work().steps, once->work().steps);
  if (GetParam().fixed_step > VirtualDuration{} || IsOde()) return;
  const std::int64_t steps = once->work().steps;
  once->AdvanceTo(AtMs(600'000));
  (void)once->Read(0);
  EXPECT_LE(once->work().steps, steps + 10);
}

TEST_P(LoadsOfEveryPath, LinearDragLeadsToTheTerminalVelocity) {
  WorldSpec world = OneBody(GetParam());
  world.gravity_mps2 = {0, 0, -10};
  world.bodies[0].drag.linear_nspm = 4;  // 5 m/s, after 0.5 s
  auto dynamics = MakeDynamics(world);
  for (int ms = 100; ms <= 3000; ms += 100) {
    dynamics->AdvanceTo(AtMs(ms));
    ASSERT_NEAR(dynamics->Read(0).linear_velocity_mps[2], 5 * std::expm1(-1e-3 * ms / 0.5),
                Near(5e-3));
  }
  dynamics->AdvanceTo(AtMs(10'000));
  EXPECT_NEAR(dynamics->Read(0).linear_velocity_mps[2], -5, 1e-7) << "of ODE, too";
}

TEST_P(LoadsOfEveryPath, QuadraticDragLeadsToTheTerminalVelocity) {
  WorldSpec world = OneBody(GetParam());
  world.gravity_mps2 = {0, 0, -10};
  world.bodies[0].drag.quadratic_ns2pm2 = 0.2;  // 10 m/s
  auto dynamics = MakeDynamics(world);
  for (int ms = 100; ms <= 3000; ms += 100) {
    dynamics->AdvanceTo(AtMs(ms));
    ASSERT_NEAR(dynamics->Read(0).linear_velocity_mps[2], -10 * std::tanh(1e-3 * ms), Near(5e-3));
  }
}

TEST_P(LoadsOfEveryPath, TheWindTakesABodyAlong) {
  WorldSpec world = OneBody(GetParam());
  world.wind.mean_mps = {3, -2, 1};
  world.bodies[0].drag.linear_nspm = 4;
  world.bodies.push_back(world.bodies[0]);
  world.bodies[1].drag = {};
  auto dynamics = MakeDynamics(world);
  for (int ms = 100; ms <= 3000; ms += 100) {
    dynamics->AdvanceTo(AtMs(ms));
    const double share = -std::expm1(-1e-3 * ms / 0.5);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ASSERT_NEAR(dynamics->Read(0).linear_velocity_mps[axis], world.wind.mean_mps[axis] * share,
                  Near(3e-3));
      ASSERT_EQ(dynamics->Read(1).linear_velocity_mps[axis], 0)
          << "one that the air does not touch";
    }
  }
}

TEST_P(LoadsOfEveryPath, TheAirBrakesWhatSpins) {
  WorldSpec world = OneBody(GetParam());
  world.bodies[0].inertia_kgm2 = {0.2, 0.2, 0.2};
  world.bodies[0].initial.angular_velocity_radps = {2, 0, 0};
  world.bodies.push_back(world.bodies[0]);
  world.bodies[0].drag.angular_linear_nmsprad = 0.4;       // after 0.5 s
  world.bodies[1].drag.angular_quadratic_nms2prad2 = 0.1;  // w' = -w^2 / 2
  auto dynamics = MakeDynamics(world);
  for (int ms = 100; ms <= 2000; ms += 100) {
    dynamics->AdvanceTo(AtMs(ms));
    const double t = 1e-3 * ms;
    ASSERT_NEAR(dynamics->Read(0).angular_velocity_radps[0], 2 * std::exp(-t / 0.5), Near(2e-3));
    ASSERT_NEAR(dynamics->Read(1).angular_velocity_radps[0], 2 / (1 + t), Near(2e-3));
    ASSERT_NEAR(dynamics->Read(0).orientation_xyzw[0], std::sin((1 - std::exp(-t / 0.5)) / 2),
                Near(2e-3));
  }
}

// What the wind is can be seen by a body that it takes along at once.
TEST_P(LoadsOfEveryPath, GustsAreAsStrongAsTheyAreToldAndTheSeedsAlone) {
  const auto speeds = [&](std::uint64_t seed, int every_ms) {
    WorldSpec world = OneBody(GetParam());
    world.integrator.accuracy = 1e-5;
    if (world.integrator.fixed_step > VirtualDuration{}) {
      world.integrator.fixed_step = VirtualDuration::Milliseconds(20);
    }
    world.bodies[0].drag.linear_nspm = 100;
    world.wind = {.mean_mps = {1, 0, 0},
                  .gusts_mps = 2,
                  .gust_time = VirtualDuration::Seconds(1),
                  .seed = seed};
    auto dynamics = MakeDynamics(world);
    std::vector<double> seen;
    for (int ms = every_ms; ms <= 100'000; ms += every_ms) {
      dynamics->AdvanceTo(AtMs(ms));
      const double speed = dynamics->Read(0).linear_velocity_mps[0];
      if (ms % 500 == 0) seen.push_back(speed);
    }
    return seen;
  };
  const std::vector<double> seen = speeds(1, 500);
  double mean = 0, square = 0, next = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    mean += seen[i] / static_cast<double>(seen.size());
    square += (seen[i] - 1) * (seen[i] - 1) / static_cast<double>(seen.size());
    if (i > 0) next += (seen[i] - 1) * (seen[i - 1] - 1) / static_cast<double>(seen.size());
  }
  EXPECT_NEAR(mean, 1, 0.6);
  EXPECT_NEAR(std::sqrt(square), 2, 0.3);
  EXPECT_NEAR(next / square, std::exp(-0.5), 0.15) << "half a gust later";
  EXPECT_EQ(speeds(1, 100), seen) << "whoever looks";
  EXPECT_NE(speeds(2, 500), seen);
}

class EveryMethodsLoads : public EveryIntegrator {};

INSTANTIATE_TEST_SUITE_P(Dynamics, EveryMethodsLoads, testing::ValuesIn(FixedAndAdaptive()),
                         NameOfParam);

TEST_P(EveryMethodsLoads, AreTakenBackToTheByte) {
  WorldSpec world = BusyWorldInTheWind(GetParam());
  ExpectTakenBackToTheByte(world, 40, Kinds::kAll);
  world.together = {{0, 1}};
  ExpectTakenBackToTheByte(world, 40, Kinds::kAll);
}

TEST(Loads, OfSimbodyEqualTheRunWithoutLeadingAfterManyCommands) {
  ExpectTakenBackToTheByte(BusyWorldInTheWind({}), ManyCommands(), Kinds::kAll);
}

TEST(Loads, OfOdeEqualTheRunWithoutLeadingAfterManyCommands) {
  ExpectTakenBackToTheByte(BusyWorldInTheWind(kOde), ManyCommands(), Kinds::kAll);
}

// Nothing of it is in the way of who does not use it.
TEST_P(EveryMethodsLoads, LeaveABodyAloneThatHasNone) {
  std::mt19937_64 random(9);
  const WorldSpec windy = BusyWorldInTheWind(GetParam());
  WorldSpec calm = BusyWorld(GetParam());
  auto commands = RandomCommands(60, 2, 10'000'000, random, Kinds::kAll);
  for (TimedCommand& command : commands) {
    if (command.body != 0) continue;
    command.wrench.in_body_frame = false;
    command.wrench.lag = {};
  }
  auto beside = MakeDynamics(windy);
  auto without = MakeDynamics(calm);
  for (const TimedCommand& command : commands) {
    beside->Apply(command.body, command.wrench, At(command.at_ns));
    if (command.body == 0) without->Apply(0, command.wrench, At(command.at_ns));
  }
  for (std::int64_t ns = 0; ns < commands.back().at_ns; ns += 10'000'000) {
    beside->AdvanceTo(At(ns));
    without->AdvanceTo(At(ns));
    (void)beside->Read(1);
    ASSERT_TRUE(SameBits(beside->Read(0), without->Read(0))) << "at " << ns;
  }
}

}  // namespace
}  // namespace tcs
