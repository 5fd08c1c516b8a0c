// The motion itself, against closed forms.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/unit/dynamics/test_worlds.h"

namespace tcs {
namespace {

// Where a body is after falling from rest for n steps of h, as each method adds it up; the others
// are exact.
double FallAsComputed(const IntegratorSpec& spec, double a, double h, int n) {
  if (spec.engine == EngineKind::kOde) return a * h * h * n * (n + 1) / 2;
  if (IsExplicitEuler(spec)) return a * h * h * n * (n - 1) / 2;
  if (spec.kind == IntegratorKind::kSemiExplicitEuler2) return a * h * h * n * (2 * n + 1) / 4;
  return a * h * h * n * n / 2;
}

TEST(FixedSteps, AreTakenAtExactlyTheirLength) {
  for (const IntegratorSpec& spec : EveryMethod(VirtualDuration::Milliseconds(10))) {
    SCOPED_TRACE(NameOf(spec));
    for (const int advance_ms : {10, 50, 1000}) {  // in pieces that the step divides: the same sum
      WorldSpec world = OneBody(spec);
      world.gravity_mps2 = {0, 0, -9.81};
      auto dynamics = MakeDynamics(world);
      for (int ms = advance_ms; ms <= 1000; ms += advance_ms) dynamics->AdvanceTo(AtMs(ms));
      const BodyState state = dynamics->Read(0);
      EXPECT_NEAR(state.position_m[2], FallAsComputed(spec, -9.81, 0.01, 100), 1e-12);
      EXPECT_NEAR(state.linear_velocity_mps[2], -9.81, 1e-12);
    }
  }
}

TEST(FixedSteps, OfOdeAreAMillisecondUnlessToldOtherwise) {
  auto world = OneBody(kOde);
  world.gravity_mps2 = {1, 0, 0};
  auto dynamics = MakeDynamics(world);
  dynamics->AdvanceTo(AtMs(100));
  EXPECT_NEAR(dynamics->Read(0).position_m[0], FallAsComputed(kOde, 1, 0.001, 100), 1e-14);
}

TEST(FixedSteps, GiveBetweenTheirEndsWhatAShorterStepGives) {
  auto world = OneBody(
      {.kind = IntegratorKind::kExplicitEuler, .fixed_step = VirtualDuration::Milliseconds(10)});
  world.gravity_mps2 = {1, 0, 0};
  auto dynamics = MakeDynamics(world);
  dynamics->AdvanceTo(AtMs(14));  // steps of 10 and 4: x = 0 + 0.010 * 0.004
  EXPECT_NEAR(dynamics->Read(0).position_m[0], 0.010 * 0.004, 1e-15);
  dynamics->AdvanceTo(AtMs(24));  // of 10, 10 and 4, whoever looked at 14
  EXPECT_NEAR(dynamics->Read(0).position_m[0], 0.010 * 0.010 + 0.020 * 0.004, 1e-15);

  // The same on ODE, which takes the new velocity for the step.
  world.integrator.engine = EngineKind::kOde;
  dynamics = MakeDynamics(world);
  dynamics->AdvanceTo(AtMs(14));
  EXPECT_NEAR(dynamics->Read(0).position_m[0], 0.010 * 0.010 + 0.014 * 0.004, 1e-15);
  dynamics->AdvanceTo(AtMs(24));
  EXPECT_NEAR(dynamics->Read(0).position_m[0], 0.010 * 0.010 + 0.020 * 0.010 + 0.024 * 0.004,
              1e-15);
}

TEST(FixedSteps, AreCountedFromACommandThatChangesSomething) {
  auto world = OneBody(
      {.kind = IntegratorKind::kExplicitEuler, .fixed_step = VirtualDuration::Milliseconds(10)});
  world.gravity_mps2 = {1, 0, 0};
  for (const EngineKind engine : {EngineKind::kSimbody, EngineKind::kOde}) {
    world.integrator.engine = engine;
    auto dynamics = MakeDynamics(world);
    dynamics->Apply(0, {}, AtMs(7));  // changes nothing
    dynamics->Apply(0, {.force_n = {0, 1, 0}, .torque_nm = {}}, AtMs(14));
    dynamics->AdvanceTo(AtMs(24));  // steps of 10 and 4, then of 10
    const bool explicit_euler = engine == EngineKind::kSimbody;
    EXPECT_NEAR(dynamics->Read(0).position_m[0],
                explicit_euler ? 0.010 * 0.004 + 0.014 * 0.010
                               : 0.010 * 0.010 + 0.014 * 0.004 + 0.024 * 0.010,
                1e-15);
  }
}

TEST(FixedSteps, HalvedShowTheOrderOfTheMethod) {
  const auto error = [](IntegratorSpec spec, int step_us) {
    spec.fixed_step = VirtualDuration::Microseconds(step_us);
    WorldSpec world = OneBody(spec);
    world.has_region = true;
    world.region = {.half_extent_m = 1.0, .stiffness_npm = 50.0, .damping_nspm = 0};
    world.bodies[0].initial.position_m = {2, 0, 0};  // swings as 1 + cos(5 t) while outside
    auto dynamics = MakeDynamics(world);
    dynamics->AdvanceTo(AtMs(200));
    return std::abs(dynamics->Read(0).position_m[0] - (1 + std::cos(1.0)));
  };
  const auto ratio = [&](IntegratorSpec spec) { return error(spec, 20000) / error(spec, 10000); };
  EXPECT_NEAR(ratio(kOde), 2, 0.2);
  EXPECT_NEAR(ratio({.kind = IntegratorKind::kExplicitEuler}), 2, 0.2);
  EXPECT_NEAR(ratio({.kind = IntegratorKind::kSemiExplicitEuler2}), 2, 0.2);
  EXPECT_NEAR(ratio({.kind = IntegratorKind::kVerlet}), 4, 0.4);
  EXPECT_NEAR(ratio({.kind = IntegratorKind::kRungeKutta3}), 8, 1.0);
  EXPECT_GT(ratio({.kind = IntegratorKind::kRungeKuttaMerson}), 14);
}

TEST_P(EveryIntegrator, FreeFallFollowsTheClosedForm) {
  WorldSpec world = OneBody(GetParam());
  world.gravity_mps2 = {0, 0, -9.81};
  world.bodies[0].initial.position_m = {1, 2, 3};
  world.bodies[0].initial.linear_velocity_mps = {4, 0, 5};
  auto dynamics = MakeDynamics(world);
  for (int ms = 1; ms <= 500; ++ms) dynamics->AdvanceTo(AtMs(ms));
  const BodyState state = dynamics->Read(0);
  const double fall = 5 * 0.5 - 9.81 * 0.5 * 0.5 / 2;
  EXPECT_NEAR(state.position_m[0], 1 + 4 * 0.5, 1e-12);
  EXPECT_NEAR(state.position_m[1], 2, 1e-12);
  EXPECT_NEAR(state.position_m[2], 3 + fall, IsFirstOrder(GetParam()) ? 2e-2 : 1e-12);
  EXPECT_NEAR(state.linear_velocity_mps[0], 4, 1e-12);
  EXPECT_NEAR(state.linear_velocity_mps[2], 5 - 9.81 * 0.5, 1e-12);
}

TEST_P(EveryIntegrator, ReachesTheTargetExactlyAndNeverGoesBeyond) {
  auto dynamics = MakeDynamics(BusyWorld(GetParam()));
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
  auto first = MakeDynamics(BusyWorld(GetParam()));
  auto second = MakeDynamics(BusyWorld(GetParam()));
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
  auto dynamics = MakeDynamics(world);
  double furthest = 0;
  for (int ms = 1; ms <= 1000; ++ms) {
    dynamics->AdvanceTo(AtMs(ms));
    furthest = std::max(furthest, dynamics->Read(0).position_m[0]);
  }
  const BodyState state = dynamics->Read(0);
  // The methods that know no curve: as good as `accuracy` makes them.
  const bool rough = IsFirstOrder(GetParam()) && GetParam().engine == EngineKind::kSimbody;
  EXPECT_NEAR(furthest, 10 + 1.0 / 5, rough ? 5e-3 : 5e-4);
  EXPECT_NEAR(state.linear_velocity_mps[0], -1, rough ? 5e-2 : 1e-3);
  EXPECT_NEAR(state.linear_velocity_mps[1], -0.25, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Dynamics, EveryIntegrator, testing::ValuesIn(FixedAndAdaptive()),
                         NameOfParam);

class BothEngines : public EveryEngine {};

INSTANTIATE_TEST_SUITE_P(Engines, BothEngines, testing::ValuesIn(Engines()), NameOfEngine);

TEST_P(BothEngines, ADampedWallTakesEnergyButNeverPulls) {
  WorldSpec world = OneBody({.engine = GetParam().engine, .accuracy = 1e-6});
  world.has_region = true;
  world.region = {.half_extent_m = 10, .stiffness_npm = 50, .damping_nspm = 8};
  world.bodies[0].initial.position_m = {0, -9.9, 0};
  world.bodies[0].initial.linear_velocity_mps = {0, -1, 0};
  world.bodies.push_back(world.bodies[0]);
  // On its way in faster than the wall could follow: a wall that pulled would slow it down.
  world.bodies[1].initial.position_m = {0, 0, 10.05};
  world.bodies[1].initial.linear_velocity_mps = {0, 0, -2};
  auto dynamics = MakeDynamics(world);
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
  EXPECT_NEAR(velocity, fastest, 1e-6) << "it was pulled back on its way in";
}

TEST_P(BothEngines, ATorqueAboutAPrincipalAxisTurnsWithThatMoment) {
  WorldSpec world = OneBody(
      {.engine = GetParam().engine, .kind = IntegratorKind::kRungeKuttaMerson, .accuracy = 1e-9});
  // Turned a quarter about z, so that the body's y axis, 0.2 kg m^2, lies along the world's -x.
  const double r = std::sqrt(0.5);
  world.bodies[0].initial.orientation_xyzw = {0, 0, r, r};
  auto dynamics = MakeDynamics(world);
  dynamics->Apply(0, {.force_n = {}, .torque_nm = {0.4, 0, 0}}, At(0));
  dynamics->AdvanceTo(AtMs(1000));
  const BodyState state = dynamics->Read(0);
  EXPECT_NEAR(state.angular_velocity_radps[0], 0.4 / 0.2, 1e-9);
  EXPECT_NEAR(state.angular_velocity_radps[1], 0, 1e-9);
  EXPECT_NEAR(state.angular_velocity_radps[2], 0, 1e-9);
  // ODE turns by each step's last velocity: 1 rad and half a step of 2 rad/s².
  const double turned = 1 + (GetParam().engine == EngineKind::kOde ? 0.0005 * 2 : 0);
  const double half_angle = 0.5 * turned;  // then the quarter turn about z, in the body
  EXPECT_NEAR(state.orientation_xyzw[0], std::sin(half_angle) * r, 1e-7);
  EXPECT_NEAR(state.orientation_xyzw[1], -std::sin(half_angle) * r, 1e-7);
  EXPECT_NEAR(state.orientation_xyzw[2], std::cos(half_angle) * r, 1e-7);
  EXPECT_NEAR(state.orientation_xyzw[3], std::cos(half_angle) * r, 1e-7);
}

// Outside of both walls at once there is no outside: a body in a region of no width to speak of
// hangs between two springs, and swings as one with the frequency of stiffness and mass.
TEST_P(BothEngines, AWallSwingsABodyWithTheFrequencyOfItsSpring) {
  WorldSpec world = OneBody(GetParam());
  world.has_region = true;
  world.region = {.half_extent_m = 1e-9, .stiffness_npm = 50, .damping_nspm = 0};
  world.bodies[0].initial.position_m = {1, 0, 0};  // cos(5 t)
  auto dynamics = MakeDynamics(world);
  int crossings = 0;
  double last = 1, first_s = 0, crossed_s = 0;
  for (int ms = 1; ms <= 20'000; ++ms) {
    dynamics->AdvanceTo(AtMs(ms));
    const double x = dynamics->Read(0).position_m[0];
    if (x * last < 0) {
      crossed_s = 0.001 * (ms - 1 + last / (last - x));
      if (++crossings == 1) first_s = crossed_s;
    }
    last = x;
  }
  ASSERT_EQ(crossings, 32);
  EXPECT_NEAR(std::numbers::pi * 31 / (crossed_s - first_s), 5, 2e-5);
}

TEST_P(BothEngines, ABodyThatTumblesKeepsItsAngularMomentum) {
  WorldSpec world = OneBody(GetParam());
  world.bodies[0].initial.angular_velocity_radps = {0.1, 3,
                                                    0.2};  // about the middle axis: it flips
  auto dynamics = MakeDynamics(world);
  const auto momentum = [&] {
    const BodyState state = dynamics->Read(0);
    const auto& [x, y, z, w] = state.orientation_xyzw;
    const double r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                            {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                            {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
    std::array<double, 3> sum{};
    for (int axis = 0; axis < 3; ++axis) {  // R diag(I) R' ω
      double along = 0;
      for (int i = 0; i < 3; ++i) along += r[i][axis] * state.angular_velocity_radps[i];
      for (int i = 0; i < 3; ++i) sum[i] += r[i][axis] * world.bodies[0].inertia_kgm2[axis] * along;
    }
    return sum;
  };
  const auto before = momentum();
  bool flipped = false;
  for (int ms = 10; ms <= 5000; ms += 10) {
    dynamics->AdvanceTo(AtMs(ms));
    const auto& [x, y, z, w] = dynamics->Read(0).orientation_xyzw;
    flipped = flipped || 1 - 2 * (x * x + z * z) < -0.9;
  }
  EXPECT_TRUE(flipped);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(momentum()[axis], before[axis], 0.01);
}

TEST_P(BothEngines, AnOrientationStaysAUnitQuaternion) {
  WorldSpec world = OneBody({.engine = GetParam().engine,
                             .kind = IntegratorKind::kExplicitEuler,
                             .fixed_step = VirtualDuration::Milliseconds(5)});
  world.bodies[0].initial.orientation_xyzw = {0.7071, 0, 0, 0.7071};
  world.bodies[0].initial.angular_velocity_radps = {0, 0, 2};  // slow: Simbody lets it drift
  auto dynamics = MakeDynamics(world);
  for (int ms = 0; ms <= 2000; ms += 20) {
    dynamics->AdvanceTo(AtMs(ms));
    const auto q = dynamics->Read(0).orientation_xyzw;
    ASSERT_NEAR(std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3])), 1, 1e-14);
  }
}

TEST_P(BothEngines, StepsOfANanosecondLateInARunNeitherStallNorDrift) {
  WorldSpec world = OneBody(GetParam());
  if (GetParam().engine != EngineKind::kSimbody) {
    world.integrator.fixed_step = VirtualDuration::Seconds(60);  // nothing pushes: as good as 1 ms
  }
  world.bodies[0].initial.linear_velocity_mps = {1, 0, 0};
  auto dynamics = MakeDynamics(world);
  const std::int64_t late = 40LL * 24 * 3600 * 1'000'000'000;  // 40 days
  dynamics->AdvanceTo(At(late));
  for (int i = 1; i <= 100; ++i) dynamics->AdvanceTo(At(late + i));
  EXPECT_EQ(dynamics->Now().ns(), late + 100);
  EXPECT_NEAR(dynamics->Read(0).position_m[0], 40.0 * 24 * 3600, 1e-5);
}

TEST_P(BothEngines, AWorldWithoutBodiesOnlyHasATime) {
  WorldSpec world;
  world.integrator = GetParam();
  auto dynamics = MakeDynamics(world);
  dynamics->AdvanceTo(AtMs(5));
  EXPECT_EQ(dynamics->Now(), AtMs(5));
}

}  // namespace
}  // namespace tcs
