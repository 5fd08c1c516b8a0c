// When a commanded wrench acts.
#include "tests/unit/dynamics/test_worlds.h"

namespace tcs {
namespace {

class Commands : public EveryEngine {};

INSTANTIATE_TEST_SUITE_P(Engines, Commands, testing::ValuesIn(Engines()), NameOfEngine);

Wrench PushX(double newtons) { return {.force_n = {newtons, 0, 0}, .torque_nm = {}}; }

TEST_P(Commands, ActFromTheirExactTimeWhereverTheStepsAre) {
  for (const std::int64_t at_ns : {12'345'678, 12'000'000, 1, 49'999'999}) {
    for (const int step_ms : {1, 50}) {
      SCOPED_TRACE(testing::Message() << at_ns << " ns, advancing by " << step_ms << " ms");
      auto dynamics = MakeDynamics(OneBody(GetParam()));
      dynamics->Apply(0, PushX(3), At(at_ns));
      for (int ms = step_ms; ms <= 50; ms += step_ms) dynamics->AdvanceTo(AtMs(ms));
      const double pushed_s = 0.05 - static_cast<double>(at_ns) * 1e-9;
      const BodyState state = dynamics->Read(0);
      EXPECT_NEAR(state.linear_velocity_mps[0], 3 / kMass * pushed_s, 1e-14);
      EXPECT_NEAR(state.position_m[0], 3 / kMass * pushed_s * pushed_s / 2,
                  PositionTolerance(GetParam(), 3 / kMass, pushed_s));
    }
  }
}

TEST(CommandsOfEveryIntegrator, AreNotIntegratedPast) {
  for (const IntegratorSpec& integrator : FixedAndAdaptive()) {
    SCOPED_TRACE(NameOf(integrator));
    auto dynamics = MakeDynamics(OneBody(integrator));
    // The integrator grows its steps while nothing happens; the command then comes at the very last
    // moment.
    dynamics->AdvanceTo(AtMs(1000));
    dynamics->Apply(0, PushX(3), AtMs(1000));
    EXPECT_EQ(dynamics->Read(0).linear_velocity_mps[0], 0);
    dynamics->AdvanceTo(At(1'000'000'001));
    EXPECT_NEAR(dynamics->Read(0).linear_velocity_mps[0], 3 / kMass * 1e-9, 1e-15);
    dynamics->Apply(0, PushX(0), AtMs(1100));
    dynamics->AdvanceTo(AtMs(2000));
    EXPECT_NEAR(dynamics->Read(0).linear_velocity_mps[0], 3 / kMass * 0.1, 1e-12);
  }
}

TEST_P(Commands, TakeEffectInTheOrderOfTheirTimes) {
  auto dynamics = MakeDynamics(OneBody(GetParam()));
  dynamics->Apply(0, PushX(0), AtMs(30));
  dynamics->Apply(0, PushX(8), AtMs(10));
  dynamics->Apply(0, PushX(-2), AtMs(20));
  dynamics->AdvanceTo(AtMs(100));
  EXPECT_NEAR(dynamics->Read(0).linear_velocity_mps[0], (8 - 2) / kMass * 0.01, 1e-14);
}

TEST_P(Commands, OfOneInstantLeaveTheLastOneStanding) {
  for (const int advance_first_ms : {0, 10}) {  // given in advance, and given at their very time
    auto dynamics = MakeDynamics(OneBody(GetParam()));
    dynamics->AdvanceTo(AtMs(advance_first_ms));
    for (const double newtons : {5.0, 7.0, 1.0}) dynamics->Apply(0, PushX(newtons), AtMs(10));
    dynamics->AdvanceTo(AtMs(20));
    EXPECT_NEAR(dynamics->Read(0).linear_velocity_mps[0], 1 / kMass * 0.01, 1e-14);
  }
}

TEST_P(Commands, MoveOnlyTheBodyTheyAreFor) {
  WorldSpec world = OneBody(GetParam());
  world.bodies.push_back(world.bodies[0]);
  auto dynamics = MakeDynamics(world);
  dynamics->Apply(1, PushX(4), At(0));
  dynamics->Apply(0, {.force_n = {0, 6, 0}, .torque_nm = {}}, At(0));
  dynamics->AdvanceTo(AtMs(10));
  EXPECT_NEAR(dynamics->Read(1).linear_velocity_mps[0], 4 / kMass * 0.01, 1e-14);
  EXPECT_EQ(dynamics->Read(1).linear_velocity_mps[1], 0);
  EXPECT_NEAR(dynamics->Read(0).linear_velocity_mps[1], 6 / kMass * 0.01, 1e-14);
  EXPECT_EQ(dynamics->Read(0).linear_velocity_mps[0], 0);
}

TEST_P(Commands, PushInTheWorldFrameHoweverTheBodyIsTurned) {
  WorldSpec world = OneBody(GetParam());
  world.bodies[0].initial.angular_velocity_radps = {0, 0, 5};
  auto dynamics = MakeDynamics(world);
  dynamics->Apply(0, PushX(3), At(0));
  dynamics->AdvanceTo(AtMs(700));
  const BodyState state = dynamics->Read(0);
  EXPECT_NEAR(state.linear_velocity_mps[0], 3 / kMass * 0.7, 1e-12);
  EXPECT_NEAR(state.linear_velocity_mps[1], 0, 1e-12);
  EXPECT_NEAR(state.angular_velocity_radps[2], 5, 1e-12) << "a force at the centre does not turn";
}

}  // namespace
}  // namespace tcs
