// The motion itself, against closed forms.
#include <cmath>

#include "tests/unit/dynamics/test_worlds.h"

namespace tcs {
namespace {

// Where a body is after falling from rest for n steps of h, as each method adds it up; the others
// are exact.
double FallAsComputed(IntegratorKind kind, double a, double h, int n) {
  if (kind == IntegratorKind::kExplicitEuler) return a * h * h * n * (n - 1) / 2;
  if (kind == IntegratorKind::kSemiExplicitEuler2) return a * h * h * n * (2 * n + 1) / 4;
  return a * h * h * n * n / 2;
}

TEST(FixedSteps, AreTakenAtExactlyTheirLength) {
  for (const IntegratorKind kind : kAllKinds) {
    SCOPED_TRACE(NameOf(kind));
    for (const int advance_ms : {10, 50, 1000}) {  // in pieces that the step divides: the same sum
      WorldSpec world = OneBody({.kind = kind, .fixed_step = VirtualDuration::Milliseconds(10)});
      world.gravity_mps2 = {0, 0, -9.81};
      auto dynamics = MakeSimbodyDynamics(world);
      for (int ms = advance_ms; ms <= 1000; ms += advance_ms) dynamics->AdvanceTo(AtMs(ms));
      const BodyState state = dynamics->Read(0);
      EXPECT_NEAR(state.position_m[2], FallAsComputed(kind, -9.81, 0.01, 100), 1e-12);
      EXPECT_NEAR(state.linear_velocity_mps[2], -9.81, 1e-12);
    }
  }
}

TEST(FixedSteps, LeaveAShorterStepBeforeAStop) {
  auto world = OneBody(
      {.kind = IntegratorKind::kExplicitEuler, .fixed_step = VirtualDuration::Milliseconds(10)});
  world.gravity_mps2 = {1, 0, 0};
  auto dynamics = MakeSimbodyDynamics(world);
  dynamics->AdvanceTo(AtMs(14));  // steps of 10 and 4: x = 0 + 0.010 * 0.004
  EXPECT_NEAR(dynamics->Read(0).position_m[0], 0.010 * 0.004, 1e-15);
  dynamics->AdvanceTo(AtMs(24));  // counted from the stop: one step of 10
  EXPECT_NEAR(dynamics->Read(0).position_m[0], 0.010 * 0.004 + 0.014 * 0.010, 1e-15);
}

TEST(FixedSteps, HalvedShowTheOrderOfTheMethod) {
  const auto error = [](IntegratorKind kind, int step_us) {
    WorldSpec world = OneBody({.kind = kind, .fixed_step = VirtualDuration::Microseconds(step_us)});
    world.has_region = true;
    world.region = {.half_extent_m = 1.0, .stiffness_npm = 50.0, .damping_nspm = 0};
    world.bodies[0].initial.position_m = {2, 0, 0};  // swings as 1 + cos(5 t) while outside
    auto dynamics = MakeSimbodyDynamics(world);
    dynamics->AdvanceTo(AtMs(200));
    return std::abs(dynamics->Read(0).position_m[0] - (1 + std::cos(1.0)));
  };
  const auto ratio = [&](IntegratorKind kind) { return error(kind, 20000) / error(kind, 10000); };
  EXPECT_NEAR(ratio(IntegratorKind::kExplicitEuler), 2, 0.2);
  EXPECT_NEAR(ratio(IntegratorKind::kSemiExplicitEuler2), 2, 0.2);
  EXPECT_NEAR(ratio(IntegratorKind::kVerlet), 4, 0.4);
  EXPECT_NEAR(ratio(IntegratorKind::kRungeKutta3), 8, 1.0);
  EXPECT_GT(ratio(IntegratorKind::kRungeKuttaMerson), 14);
}

TEST_P(EveryIntegrator, FreeFallFollowsTheClosedForm) {
  WorldSpec world = OneBody(GetParam());
  world.gravity_mps2 = {0, 0, -9.81};
  world.bodies[0].initial.position_m = {1, 2, 3};
  world.bodies[0].initial.linear_velocity_mps = {4, 0, 5};
  auto dynamics = MakeSimbodyDynamics(world);
  for (int ms = 1; ms <= 500; ++ms) dynamics->AdvanceTo(AtMs(ms));
  const BodyState state = dynamics->Read(0);
  const bool euler = GetParam().kind == IntegratorKind::kExplicitEuler ||
                     GetParam().kind == IntegratorKind::kSemiExplicitEuler2;
  const double fall = 5 * 0.5 - 9.81 * 0.5 * 0.5 / 2;
  EXPECT_NEAR(state.position_m[0], 1 + 4 * 0.5, 1e-12);
  EXPECT_NEAR(state.position_m[1], 2, 1e-12);
  EXPECT_NEAR(state.position_m[2], 3 + fall, euler ? 3e-3 : 1e-12);
  EXPECT_NEAR(state.linear_velocity_mps[0], 4, 1e-12);
  EXPECT_NEAR(state.linear_velocity_mps[2], 5 - 9.81 * 0.5, 1e-12);
}

TEST_P(EveryIntegrator, ReachesTheTargetExactlyAndNeverGoesBeyond) {
  auto dynamics = MakeSimbodyDynamics(BusyWorld(GetParam()));
  std::int64_t ns = 0;
  for (int i = 0; i < 60; ++i) {
    ns += 1 + (i * 7'654'321LL) % 9'999'991;
    dynamics->AdvanceTo(At(ns));
    ASSERT_EQ(dynamics->Now().ns(), ns);
  }
  const BodyState before = dynamics->Read(0);
  dynamics->AdvanceTo(At(ns));  // nothing to do
  EXPECT_TRUE(SameBits(before, dynamics->Read(0)));
}

TEST_P(EveryIntegrator, TwoInstancesGiveTheSameBits) {
  auto first = MakeSimbodyDynamics(BusyWorld(GetParam()));
  auto second = MakeSimbodyDynamics(BusyWorld(GetParam()));
  for (int i = 1; i <= 100; ++i) {
    for (Dynamics* dynamics : {first.get(), second.get()}) {
      dynamics->Apply(i % 2, {.force_n = {i % 5 - 2.0, 1, 0}, .torque_nm = {0, 0, 0.01 * i}},
                      At(i * 10'000'000 - 3'333'333));
      dynamics->AdvanceTo(AtMs(10 * i));
    }
    ASSERT_TRUE(SameBits(ReadAll(*first, 2), ReadAll(*second, 2))) << "at " << 10 * i << " ms";
  }
  EXPECT_NE(first->Read(0).position_m[0], -0.5) << "it did not move at all";
}

TEST_P(EveryIntegrator, AWallReturnsABodyWithItsEnergy) {
  WorldSpec world = OneBody(GetParam());
  world.has_region = true;  // sqrt(50 N/m / 2 kg) = 5 rad/s: half a period outside takes 0.628 s
  world.bodies[0].initial.position_m = {9.9, 0, 0};
  world.bodies[0].initial.linear_velocity_mps = {1, -0.25, 0};
  auto dynamics = MakeSimbodyDynamics(world);
  double furthest = 0;
  for (int ms = 1; ms <= 1000; ++ms) {
    dynamics->AdvanceTo(AtMs(ms));
    furthest = std::max(furthest, dynamics->Read(0).position_m[0]);
  }
  const BodyState state = dynamics->Read(0);
  const bool explicit_euler = GetParam().kind == IntegratorKind::kExplicitEuler;
  EXPECT_NEAR(furthest, 10 + 1.0 / 5, explicit_euler ? 2e-3 : 5e-4);
  EXPECT_NEAR(state.linear_velocity_mps[0], -1, explicit_euler ? 1e-2 : 1e-3);
  EXPECT_NEAR(state.linear_velocity_mps[1], -0.25, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Dynamics, EveryIntegrator, testing::ValuesIn(FixedAndAdaptive()),
                         NameOfParam);

TEST(Dynamics, ADampedWallTakesEnergyButNeverPulls) {
  WorldSpec world =
      OneBody({.kind = IntegratorKind::kRungeKutta3, .fixed_step = {}, .accuracy = 1e-6});
  world.has_region = true;
  world.region = {.half_extent_m = 10, .stiffness_npm = 50, .damping_nspm = 8};
  world.bodies[0].initial.position_m = {0, -9.9, 0};
  world.bodies[0].initial.linear_velocity_mps = {0, -1, 0};
  world.bodies.push_back(world.bodies[0]);
  // On its way in faster than the wall could follow: a wall that pulled would slow it down.
  world.bodies[1].initial.position_m = {0, 0, 10.05};
  world.bodies[1].initial.linear_velocity_mps = {0, 0, -2};
  auto dynamics = MakeSimbodyDynamics(world);
  dynamics->AdvanceTo(AtMs(20));
  EXPECT_EQ(dynamics->Read(1).linear_velocity_mps[2], -2);
  double fastest = 0;
  for (int ms = 21; ms <= 1500; ++ms) {
    dynamics->AdvanceTo(AtMs(ms));
    fastest = std::max(fastest, dynamics->Read(0).linear_velocity_mps[1]);
  }
  const double velocity = dynamics->Read(0).linear_velocity_mps[1];
  EXPECT_GT(velocity, 0.2);
  EXPECT_LT(velocity, 0.7);
  EXPECT_EQ(velocity, fastest) << "it was pulled back on its way in";
}

TEST(Dynamics, ATorqueAboutAPrincipalAxisTurnsWithThatMoment) {
  WorldSpec world =
      OneBody({.kind = IntegratorKind::kRungeKuttaMerson, .fixed_step = {}, .accuracy = 1e-9});
  // Turned a quarter about z, so that the body's y axis, 0.2 kg m^2, lies along the world's -x.
  const double r = std::sqrt(0.5);
  world.bodies[0].initial.orientation_xyzw = {0, 0, r, r};
  auto dynamics = MakeSimbodyDynamics(world);
  dynamics->Apply(0, {.force_n = {}, .torque_nm = {0.4, 0, 0}}, At(0));
  dynamics->AdvanceTo(AtMs(1000));
  const BodyState state = dynamics->Read(0);
  EXPECT_NEAR(state.angular_velocity_radps[0], 0.4 / 0.2, 1e-9);
  EXPECT_NEAR(state.angular_velocity_radps[1], 0, 1e-9);
  EXPECT_NEAR(state.angular_velocity_radps[2], 0, 1e-9);
  const double half_angle =
      0.5 * (0.4 / 0.2) * 1 * 1 / 2;  // then the quarter turn about z, in the body
  EXPECT_NEAR(state.orientation_xyzw[0], std::sin(half_angle) * r, 1e-7);
  EXPECT_NEAR(state.orientation_xyzw[1], -std::sin(half_angle) * r, 1e-7);
  EXPECT_NEAR(state.orientation_xyzw[2], std::cos(half_angle) * r, 1e-7);
  EXPECT_NEAR(state.orientation_xyzw[3], std::cos(half_angle) * r, 1e-7);
}

TEST(Dynamics, AnOrientationStaysAUnitQuaternion) {
  WorldSpec world = OneBody(
      {.kind = IntegratorKind::kExplicitEuler, .fixed_step = VirtualDuration::Milliseconds(5)});
  world.bodies[0].initial.orientation_xyzw = {0.7071, 0, 0, 0.7071};
  world.bodies[0].initial.angular_velocity_radps = {0, 0, 2};  // slow: Simbody lets it drift
  auto dynamics = MakeSimbodyDynamics(world);
  for (int ms = 0; ms <= 2000; ms += 20) {
    dynamics->AdvanceTo(AtMs(ms));
    const auto q = dynamics->Read(0).orientation_xyzw;
    ASSERT_NEAR(std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3])), 1, 1e-14);
  }
}

TEST(Dynamics, StepsOfANanosecondLateInARunNeitherStallNorDrift) {
  WorldSpec world = OneBody();
  world.bodies[0].initial.linear_velocity_mps = {1, 0, 0};
  auto dynamics = MakeSimbodyDynamics(world);
  const std::int64_t late = 40LL * 24 * 3600 * 1'000'000'000;  // 40 days
  dynamics->AdvanceTo(At(late));
  for (int i = 1; i <= 100; ++i) dynamics->AdvanceTo(At(late + i));
  EXPECT_EQ(dynamics->Now().ns(), late + 100);
  EXPECT_NEAR(dynamics->Read(0).position_m[0], 40.0 * 24 * 3600, 1e-5);
}

TEST(Dynamics, AWorldWithoutBodiesOnlyHasATime) {
  auto dynamics = MakeSimbodyDynamics(WorldSpec{});
  dynamics->AdvanceTo(AtMs(5));
  EXPECT_EQ(dynamics->Now(), AtMs(5));
}

}  // namespace
}  // namespace tcs
