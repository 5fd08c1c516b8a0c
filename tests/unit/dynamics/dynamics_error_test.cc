// What Dynamics refuses, and in which words.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "tests/unit/dynamics/test_worlds.h"

namespace tcs {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Expects that `world` is refused with exactly `message`.
void ExpectRefused(const WorldSpec& world, const std::string& message) {
  try {
    MakeDynamics(world);
    ADD_FAILURE() << "accepted, instead of: " << message;
  } catch (const DynamicsError& e) {
    EXPECT_EQ(e.what(), message);
  }
}

class DynamicsErrors : public EveryEngine {};
class DynamicsDeathTest : public EveryEngine {};

INSTANTIATE_TEST_SUITE_P(Engines, DynamicsErrors, testing::ValuesIn(Engines()), NameOfEngine);
INSTANTIATE_TEST_SUITE_P(Engines, DynamicsDeathTest, testing::ValuesIn(Engines()), NameOfEngine);

TEST_P(DynamicsErrors, NameTheBodyWithoutAMass) {
  WorldSpec world = OneBody(GetParam());
  world.bodies[0].mass_kg = 0;
  ExpectRefused(world, "body 'ship': the mass must be positive and finite, but is 0 kg");
  world.bodies[0].mass_kg = -1.5;
  ExpectRefused(world, "body 'ship': the mass must be positive and finite, but is -1.5 kg");
  world.bodies[0].mass_kg = kNan;
  ExpectRefused(world, "body 'ship': the mass must be positive and finite, but is nan kg");
  world.bodies[0].mass_kg = kInfinity;
  ExpectRefused(world, "body 'ship': the mass must be positive and finite, but is inf kg");
}

TEST_P(DynamicsErrors, NameTheBodyWithAnImpossibleInertia) {
  WorldSpec world = OneBody(GetParam());
  world.bodies.push_back(world.bodies[0]);
  world.bodies[1].name = "stick";
  world.bodies[1].inertia_kgm2 = {1, 2, 3.5};
  ExpectRefused(
      world,
      "body 'stick': no rigid body has the principal moments of inertia (1, 2, 3.5) kg m^2, "
      "because one of them exceeds the sum of the two others");
  world.bodies[1].inertia_kgm2 = {0, 1, 1};
  ExpectRefused(
      world,
      "body 'stick': the principal moments of inertia must be positive and finite, but are "
      "(0, 1, 1) kg m^2");
  world.bodies[1].inertia_kgm2 = {1, kNan, 1};
  ExpectRefused(
      world,
      "body 'stick': the principal moments of inertia must be positive and finite, but are "
      "(1, nan, 1) kg m^2");
  world.bodies[1].inertia_kgm2 = {0.3, 0.1, 0.2};  // flat, and rounded the wrong way: allowed
  EXPECT_NO_THROW(MakeDynamics(world));
}

TEST_P(DynamicsErrors, NameTheBodyWithAnInitialStateThatIsNone) {
  WorldSpec world = OneBody(GetParam());
  world.bodies[0].initial.linear_velocity_mps[1] = kNan;
  ExpectRefused(world, "body 'ship': the initial state must be finite");
  world = OneBody(GetParam());
  world.bodies[0].initial.orientation_xyzw = {0, 0, 0, 2};
  ExpectRefused(
      world, "body 'ship': the initial orientation must be a unit quaternion, but its length is 2");
}

TEST_P(DynamicsErrors, NameTheFieldOfTheWorld) {
  WorldSpec world = OneBody(GetParam());
  world.gravity_mps2[2] = kInfinity;
  ExpectRefused(world, "gravity: it must be finite");
  world = OneBody(GetParam());
  world.has_region = true;
  world.region.half_extent_m = 0;
  ExpectRefused(world, "region: the half extent must be positive and finite, but is 0 m");
  world.region = {.half_extent_m = 1, .stiffness_npm = -50, .damping_nspm = 0};
  ExpectRefused(world, "region: the stiffness must be finite and not negative, but is -50 N/m");
  world.region = {.half_extent_m = 1, .stiffness_npm = 50, .damping_nspm = kNan};
  ExpectRefused(world, "region: the damping must be finite and not negative, but is nan N s/m");
  ExpectRefused(
      OneBody({.engine = GetParam().engine, .fixed_step = VirtualDuration::Nanoseconds(-1)}),
      "integrator: the fixed step must not be negative, but is -1 ns");
}

TEST_P(DynamicsErrors, NameWhatIsNoAir) {
  WorldSpec world = OneBody(GetParam());
  world.bodies[0].drag.quadratic_ns2pm2 = -1;
  ExpectRefused(world,
                "body 'ship': each factor of the drag must be finite and not negative, but one is "
                "-1");
  world = OneBody(GetParam());
  world.wind.mean_mps[0] = kNan;
  ExpectRefused(world, "wind: its velocity must be finite");
  world.wind = {.gusts_mps = -1};
  ExpectRefused(world, "wind: the gusts must be finite and not negative, but are -1 m/s");
  world.wind = {.gusts_mps = 1, .gust_time = {}};
  ExpectRefused(world, "wind: the time of the gusts must be more than 0, but is 0 ns");
}

TEST_P(DynamicsErrors, RefuseALagThatIsNegative) {
  auto dynamics = MakeDynamics(OneBody(GetParam()));
  try {
    dynamics->Apply(0, {.lag = VirtualDuration::Nanoseconds(-1)}, AtMs(1));
    ADD_FAILURE() << "accepted";
  } catch (const DynamicsError& e) {
    EXPECT_STREQ(e.what(), "body 'ship': the lag of a command must not be negative, but is -1 ns");
  }
}

TEST_P(DynamicsErrors, RefuseAWrenchThatIsNotFiniteAndGoOn) {
  auto dynamics = MakeDynamics(OneBody(GetParam()));
  try {
    dynamics->Apply(0, {.force_n = {0, 0, 0}, .torque_nm = {0, kNan, 0}}, AtMs(1));
    ADD_FAILURE() << "accepted";
  } catch (const DynamicsError& e) {
    EXPECT_STREQ(e.what(), "body 'ship': a commanded wrench must be finite");
  }
  dynamics->AdvanceTo(AtMs(10));
  EXPECT_EQ(dynamics->Read(0).angular_velocity_radps[1], 0);
}

// A wall far too stiff for the step: every step throws the body further out than the one before.
TEST_P(DynamicsErrors, NameTheBodyThatDivergesAndRestoreRecovers) {
  WorldSpec world = OneBody({.engine = GetParam().engine,
                             .kind = IntegratorKind::kExplicitEuler,
                             .fixed_step = VirtualDuration::Milliseconds(100)});
  world.bodies.push_back(world.bodies[0]);
  world.bodies[1].name = "rocket";
  world.bodies[1].initial.position_m = {11, 0, 0};
  world.has_region = true;
  world.region.stiffness_npm = 1e60;
  auto dynamics = MakeDynamics(world);
  const auto checkpoint = dynamics->Save();
  for (int attempt = 0; attempt < 2; ++attempt) {
    try {
      dynamics->AdvanceTo(AtMs(10'000));
      (void)dynamics->Read(0);
      (void)dynamics->Read(1);
      ADD_FAILURE() << "went on";
    } catch (const DynamicsError& e) {
      EXPECT_THAT(e.what(),
                  testing::MatchesRegex("body 'rocket': its motion has diverged by [0-9.]+ s"));
    }
    dynamics->Restore(*checkpoint);
    EXPECT_EQ(dynamics->Read(1).position_m[0], 11);
  }
}

// What is read fails, not what time it is; and no more of the world than is read.
TEST_P(DynamicsErrors, AreThoseOfTheBodyThatIsReadAndCanBeAverted) {
  WorldSpec world = OneBody({.engine = GetParam().engine,
                             .kind = IntegratorKind::kExplicitEuler,
                             .fixed_step = VirtualDuration::Milliseconds(100)});
  world.bodies.push_back(world.bodies[0]);
  // MuJoCo takes no number beyond 1e10.
  const bool is_mujoco = GetParam().engine == EngineKind::kMujoco;
  const double force_n = is_mujoco ? 1e10 : 1e308;
  world.bodies[1].initial.linear_velocity_mps = {is_mujoco ? 1e9 : 1e308, 0, 0};
  auto dynamics = MakeDynamics(world);
  dynamics->Apply(1, {.force_n = {force_n, 0, 0}, .torque_nm = {}}, AtMs(0));
  const std::array both{0, 1};
  std::array<BodyState, 2> states;
  EXPECT_THROW(dynamics->Read(AtMs(5000), both, states), DynamicsError);
  EXPECT_THROW(dynamics->Read(AtMs(5000), both, states), DynamicsError) << "the second time";
  EXPECT_NO_THROW(dynamics->Read(AtMs(5000), {&both[0], 1}, {&states[0], 1}));
  dynamics->Apply(1, {.force_n = {-force_n, 0, 0}, .torque_nm = {}}, AtMs(0));
  EXPECT_NO_THROW(dynamics->Read(AtMs(1000), both, states));
}

TEST(SimbodyErrors, NameTheAccuracyThatIsNone) {
  ExpectRefused(OneBody({.accuracy = 0}),
                "integrator: the accuracy must lie between 0 and 1, but is 0");
}

TEST(SimbodyErrors, TellWhenErrorControlFindsNoStepSmallEnough) {
  WorldSpec world = OneBody();
  world.has_region = true;
  world.region.stiffness_npm = 1e300;
  world.bodies[0].initial.position_m = {11e9, 0, 0};
  auto dynamics = MakeDynamics(world);
  try {
    dynamics->AdvanceTo(AtMs(10));
    (void)dynamics->Read(0);
    ADD_FAILURE() << "went on";
  } catch (const DynamicsError& e) {
    EXPECT_THAT(e.what(), testing::StartsWith("body 'ship': the integration from 0 s on failed: "));
    EXPECT_THAT(e.what(), testing::Not(testing::HasSubstr("\n")));
  }
}

TEST_P(DynamicsDeathTest, TimeOnlyGoesForward) {
  auto dynamics = MakeDynamics(OneBody(GetParam()));
  dynamics->AdvanceTo(AtMs(2));
  EXPECT_DEATH(dynamics->AdvanceTo(AtMs(1)), "can only advance to a later, finite time");
  EXPECT_DEATH(dynamics->AdvanceTo(VirtualTime::Never()),
               "can only advance to a later, finite time");
  EXPECT_DEATH(dynamics->Apply(0, {}, AtMs(1)), "cannot act before the dynamics' present");
  EXPECT_DEATH(dynamics->Apply(1, {}, AtMs(3)), "no such body");
  EXPECT_DEATH((void)dynamics->Read(-1), "no such body");
}

}  // namespace
}  // namespace tcs
