// What is ODE's own.
#include <gmock/gmock.h>
#include <ode/ode.h>

#include "simbody_bridge/ode/ode_library.h"
#include "tests/unit/dynamics/test_worlds.h"

namespace tcs {
namespace {

TEST(Ode, SaysWhatItTakesForAnErrorInOneSentenceAndCanBeUsedAfterwards) {
  OpenOde();
  const dWorldID world = dWorldCreate();
  try {
    dWorldStep(world, -1);  // an assertion of ODE's own
    ADD_FAILURE() << "accepted";
  } catch (const DynamicsError& e) {
    EXPECT_THAT(e.what(), testing::MatchesRegex("ODE, error [0-9]+: stepsize must be .*"));
    EXPECT_THAT(e.what(), testing::Not(testing::HasSubstr("\n")));
  }
  EXPECT_THROW(dError(3, "two\nlines"), DynamicsError);
  dWorldDestroy(world);
  auto dynamics = MakeDynamics(BusyWorld(kOde));
  dynamics->AdvanceTo(AtMs(10));
  EXPECT_EQ(dynamics->Now(), AtMs(10));
}

TEST(Ode, ComputesTheSameBesideOtherWorlds) {
  auto alone = MakeDynamics(BusyWorld(kOde));
  alone->AdvanceTo(AtMs(500));
  auto first = MakeDynamics(BusyWorld(kOde));
  auto second = MakeDynamics(OneBody(kOde));
  for (int ms = 1; ms <= 500; ++ms) {
    second->AdvanceTo(AtMs(ms));
    first->AdvanceTo(AtMs(ms));
  }
  EXPECT_TRUE(SameBits(ReadAll(*alone, 2), ReadAll(*first, 2)));
}

// Close to each other where both are near the truth: a tumbling body pushed about between walls.
TEST(Ode, GoesWhereSimbodyGoes) {
  WorldSpec world = OneBody(kOde);
  world.has_region = true;
  world.bodies[0].initial.position_m = {9, 0, 0};
  world.bodies[0].initial.linear_velocity_mps = {2, 1, 0};
  world.bodies[0].initial.angular_velocity_radps = {0.3, 0.2, 1};
  std::vector<BodyState> ends;
  for (const EngineKind engine : {EngineKind::kOde, EngineKind::kSimbody}) {
    world.integrator = {.engine = engine, .accuracy = 1e-9};
    auto dynamics = MakeDynamics(world);
    dynamics->Apply(0, {.force_n = {1, 0, 0.5}, .torque_nm = {0, 0.02, 0}}, AtMs(100));
    dynamics->Apply(0, {}, AtMs(1500));
    dynamics->AdvanceTo(AtMs(2000));
    ends.push_back(dynamics->Read(0));
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(ends[0].position_m[axis], ends[1].position_m[axis], 5e-3);
    EXPECT_NEAR(ends[0].linear_velocity_mps[axis], ends[1].linear_velocity_mps[axis], 5e-3);
    EXPECT_NEAR(ends[0].angular_velocity_radps[axis], ends[1].angular_velocity_radps[axis], 5e-3);
    EXPECT_NEAR(ends[0].orientation_xyzw[axis], ends[1].orientation_xyzw[axis], 5e-3);
  }
}

}  // namespace
}  // namespace tcs
