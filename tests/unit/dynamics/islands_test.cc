// What the motion of a body depends on, what it costs, and that it does not depend on anything
// else: not on when it is read, nor on other islands, nor on what had to be taken back.
#include <algorithm>
#include <random>

#include "tests/unit/dynamics/random_commands.h"
#include "tests/unit/dynamics/test_worlds.h"

namespace tcs {
namespace {

class EveryMethodsIslands : public EveryIntegrator {};

TEST_P(EveryMethodsIslands, MoveABodyAlikeHoweverOftenItIsLookedAt) {
  std::mt19937_64 random(7);
  const auto commands = RandomCommands(60, 2, 20'000'000, random);
  const std::int64_t end_ns = commands.back().at_ns + 30'000'000;
  auto seldom = MakeDynamics(BusyWorld(GetParam()));
  ApplyAll(commands, *seldom);
  auto often = MakeDynamics(BusyWorld(GetParam()));
  auto next = commands.begin();
  for (std::int64_t ns = 0; ns < end_ns;) {
    const std::int64_t to_ns = std::min<std::int64_t>(end_ns, ns + 1 + random() % 3'000'000);
    // What is given for an instant that was read, and what is given in advance.
    for (; next != commands.end() && next->at_ns <= to_ns; ++next) {
      often->Apply(next->body, next->wrench, At(next->at_ns));
    }
    ns = to_ns;
    often->AdvanceTo(At(ns));
    if (random() % 3 == 0) (void)often->Read(static_cast<int>(random() % 2));
    if (random() % 20 == 0) {
      ASSERT_TRUE(SameBits(StatesAt(*often, ns, 2), StatesAt(*seldom, ns, 2))) << "at " << ns;
    }
  }
  EXPECT_TRUE(SameBits(StatesAt(*often, end_ns, 2), StatesAt(*seldom, end_ns, 2)));
  EXPECT_GT(often->work().changes, 20);
}

TEST(Islands, OfSimbodyEqualTheRunWithoutLeadingAfterManyCommands) {
  ExpectTakenBackToTheByte(BusyWorld({}), ManyCommands());
}

TEST(Islands, OfOdeEqualTheRunWithoutLeadingAfterManyCommands) {
  ExpectTakenBackToTheByte(BusyWorld(kOde), ManyCommands());
}

#ifdef TCS_HAS_MUJOCO
TEST(Islands, OfMujocoEqualTheRunWithoutLeadingAfterManyCommands) {
  ExpectTakenBackToTheByte(BusyWorld({.engine = EngineKind::kMujoco}), ManyCommands());
}
#endif

TEST_P(EveryMethodsIslands, TakeBackToTheByteWhatACommandMakesWrong) {
  WorldSpec world = BusyWorld(GetParam());
  ExpectTakenBackToTheByte(world, 40);
  world.together = {{0, 1}};
  ExpectTakenBackToTheByte(world, 40);
}

INSTANTIATE_TEST_SUITE_P(Dynamics, EveryMethodsIslands, testing::ValuesIn(FixedAndAdaptive()),
                         NameOfParam);

class EachEngine : public EveryEngine {};

INSTANTIATE_TEST_SUITE_P(Engines, EachEngine, testing::ValuesIn(Engines()), NameOfEngine);

WorldSpec ManyBodies(int bodies, const IntegratorSpec& integrator) {
  WorldSpec world = OneBody(integrator);
  world.bodies.resize(static_cast<std::size_t>(bodies), world.bodies[0]);
  return world;
}

TEST_P(EachEngine, CommandsThatChangeNothingCostNothing) {
  const Wrench push{.force_n = {1, 0, 0}, .torque_nm = {0, 0, 0.01}};
  auto repeated = MakeDynamics(OneBody(GetParam()));
  auto once = MakeDynamics(OneBody(GetParam()));
  once->Apply(0, push, AtMs(5));
  for (int ms = 5; ms <= 2000; ms += 5) {
    repeated->Apply(0, push, AtMs(ms));
    repeated->AdvanceTo(AtMs(ms));
    once->AdvanceTo(AtMs(ms));
    ASSERT_TRUE(SameBits(repeated->Read(0), once->Read(0))) << "at " << ms << " ms";
  }
  EXPECT_EQ(repeated->work().changes, 1);
  EXPECT_EQ(repeated->work().steps, once->work().steps);
}

// Of two commands for one instant the last one stays: if that is what acted already, nothing has
// changed, and nothing of the first one is left.
TEST_P(EachEngine, ACommandThatIsTakenBackInItsInstantLeavesNothing) {
  const Wrench push{.force_n = {1, 0, 0}, .torque_nm = {0, 0.01, 0.02}};
  WorldSpec world = OneBody(GetParam());
  world.bodies[0].initial.angular_velocity_radps = {1, 2, 3};
  auto changed = MakeDynamics(world);
  auto plain = MakeDynamics(world);
  for (int ms = 7; ms <= 700; ms += 7) {
    for (Dynamics* dynamics : {changed.get(), plain.get()}) {
      dynamics->AdvanceTo(At(1'000'000LL * ms + 300));
      (void)dynamics->Read(0);
    }
    changed->Apply(0, push, changed->Now());
    changed->Apply(0, {}, changed->Now());
    ASSERT_TRUE(SameBits(changed->Read(0), plain->Read(0))) << "at " << ms << " ms";
  }
  EXPECT_EQ(changed->work().changes, 0);
}

TEST_P(EachEngine, TimeAndWhatNobodyReadsCostNothing) {
  auto dynamics = MakeDynamics(ManyBodies(3, GetParam()));
  for (int ms = 0; ms <= 1000; ++ms) {
    dynamics->Apply(ms % 3, {.force_n = {1.0 + ms, 0, 0}, .torque_nm = {}}, AtMs(ms + 2000));
    dynamics->AdvanceTo(AtMs(ms));
  }
  EXPECT_EQ(dynamics->work().steps, 0);
  (void)dynamics->Read(1);
  const std::int64_t of_one = dynamics->work().steps;
  EXPECT_GT(of_one, 0);
  (void)dynamics->Read(1);
  EXPECT_EQ(dynamics->work().steps, of_one);
  (void)dynamics->Read(0);
  EXPECT_EQ(dynamics->work().steps, 2 * of_one) << "the third is left alone";
}

// A controller and a sensor at 100 Hz: one step for each command, not one for whoever looks.
TEST(Islands, TakeOneStepForEachCommandThatChangesSomething) {
  auto dynamics = MakeDynamics(ManyBodies(2, {}));
  for (int i = 0; i < 1000; ++i) {
    const std::int64_t sample_ns = 10'000'000LL * (i + 1);
    dynamics->AdvanceTo(At(sample_ns));
    (void)dynamics->Read(0);
    dynamics->Apply(0, {.force_n = {1.0 * (i % 3), 0, 0}, .torque_nm = {0, 0.01 * (i % 2), 0}},
                    At(sample_ns + 1'500'000));
  }
  EXPECT_LE(dynamics->work().steps, 1010);
  EXPECT_EQ(dynamics->work().changes, 998)
      << "the first changes nothing; nobody reads past the last";
}

TEST_P(EachEngine, CommandsToABodyThatNobodyReadsDoNotPileUp) {
  auto dynamics = MakeDynamics(OneBody(GetParam()));
  for (int ms = 1; ms <= 1000; ++ms) {
    dynamics->AdvanceTo(AtMs(ms));
    dynamics->Apply(0, {.force_n = {1.0 * (ms % 2), 0, 0}, .torque_nm = {}}, AtMs(ms));
  }
  EXPECT_GT(dynamics->work().changes, 900);
}

// A world that has one of the bodies only, with the commands to it, at that time.
std::unique_ptr<Dynamics> Alone(const WorldSpec& world, int body,
                                const std::vector<TimedCommand>& commands, std::int64_t end_ns) {
  WorldSpec part = world;
  part.bodies = {world.bodies[static_cast<std::size_t>(body)]};
  auto alone = MakeDynamics(part);
  for (const TimedCommand& command : commands) {
    if (command.body == body) alone->Apply(0, command.wrench, At(command.at_ns));
  }
  alone->AdvanceTo(At(end_ns));
  return alone;
}

TEST_P(EveryMethodsIslands, MoveABodyAsIfItWereAlone) {
  std::mt19937_64 random(3);
  const WorldSpec world = BusyWorld(GetParam());
  const auto commands = RandomCommands(30, 2, 20'000'000, random);
  auto both = MakeDynamics(world);
  ApplyAll(commands, *both);
  const std::int64_t end_ns = commands.back().at_ns + 10'000'000;
  for (const int body : {0, 1}) {
    auto alone = Alone(world, body, commands, end_ns);
    both->AdvanceTo(At(end_ns));
    EXPECT_TRUE(SameBits(alone->Read(0), both->Read(body)));
  }
}

// Whether many of them or few are integrated at once.
TEST(Islands, OfUnlikeBodiesMoveAsIfTheyWereAlone) {
  constexpr int kBodies = 6;
  std::mt19937_64 random(5);
  WorldSpec world = BusyWorld({});
  world.bodies.resize(kBodies, world.bodies[0]);
  for (int i = 0; i < kBodies; ++i) world.bodies[static_cast<std::size_t>(i)].mass_kg += i % 4;
  const auto commands = RandomCommands(200, kBodies, 3'000'000, random);
  auto all = MakeDynamics(world);
  ApplyAll(commands, *all);
  const std::int64_t end_ns = commands.back().at_ns;
  for (std::int64_t ns = 0; ns < end_ns; ns += 10'000'000) {
    all->AdvanceTo(At(ns));
    if (random() % 2 == 0) (void)StatesAt(*all, ns, static_cast<int>(1 + random() % kBodies));
  }
  all->AdvanceTo(At(end_ns));
  const auto states = StatesAt(*all, end_ns, kBodies);
  for (int body = 0; body < kBodies; ++body) {
    auto alone = Alone(world, body, commands, end_ns);
    EXPECT_TRUE(SameBits(alone->Read(0), states[static_cast<std::size_t>(body)])) << body;
  }
}

TEST(Islands, ThatAreDeclaredTogetherMoveAlikeWithinTheAccuracy) {
  WorldSpec world = BusyWorld({.accuracy = 1e-8});
  EXPECT_EQ(MakeDynamics(world)->island_count(), 2);
  auto apart = MakeDynamics(world);
  world.together = {{1, 0}};
  auto together = MakeDynamics(world);
  EXPECT_EQ(together->island_count(), 1);
  for (Dynamics* dynamics : {apart.get(), together.get()}) {
    dynamics->Apply(0, {.force_n = {1, 2, 3}, .torque_nm = {}}, AtMs(33));
    dynamics->Apply(1, {.force_n = {-1, 0, 3}, .torque_nm = {0, 0.1, 0}}, AtMs(77));
    dynamics->AdvanceTo(AtMs(500));
  }
  for (const int body : {0, 1}) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(apart->Read(body).position_m[axis], together->Read(body).position_m[axis], 1e-6);
    }
  }
}

TEST(Islands, RefuseABodyInTwoOfThem) {
  WorldSpec world = ManyBodies(3, {});
  world.together = {{0, 1}, {1, 2}};
  EXPECT_THROW(MakeDynamics(world), DynamicsError);
  world.together = {{3}};
  EXPECT_THROW(MakeDynamics(world), DynamicsError);
}

// The steps that are taken here on Simbody's derivatives lead where Simbody's own integrator goes.
TEST(Islands, OfRungeKutta3GoWhereSimbodysIntegratorsGo) {
  std::mt19937_64 random(2);
  const auto commands = RandomCommands(40, 2, 20'000'000, random);
  const std::int64_t end_ns = 800'000'000;
  auto here = MakeDynamics(BusyWorld({.accuracy = 1e-7}));
  auto there = MakeDynamics(
      BusyWorld({.kind = IntegratorKind::kRungeKuttaMerson, .fixed_step = {}, .accuracy = 1e-9}));
  for (Dynamics* dynamics : {here.get(), there.get()}) ApplyAll(commands, *dynamics);
  for (std::int64_t ns = 0; ns <= end_ns; ns += 50'000'000) {
    const auto a = StatesAt(*here, ns, 2), b = StatesAt(*there, ns, 2);
    for (std::size_t body = 0; body < 2; ++body) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ASSERT_NEAR(a[body].position_m[axis], b[body].position_m[axis], 1e-5);
        ASSERT_NEAR(a[body].linear_velocity_mps[axis], b[body].linear_velocity_mps[axis], 1e-4);
        ASSERT_NEAR(a[body].angular_velocity_radps[axis], b[body].angular_velocity_radps[axis],
                    1e-5);
        ASSERT_NEAR(a[body].orientation_xyzw[axis], b[body].orientation_xyzw[axis], 1e-5);
      }
    }
  }
}

// The accuracy is of a step's end; what is read in between is as good.
TEST(Islands, AreAsAccurateBetweenTheirStepsAsTheyAreTold) {
  for (const double accuracy : {1e-3, 1e-5, 1e-7}) {
    WorldSpec world = OneBody({.accuracy = accuracy});
    world.has_region = true;
    world.region = {.half_extent_m = 1.0, .stiffness_npm = 50.0, .damping_nspm = 0};
    world.bodies[0].initial.position_m = {2, 0, 0};  // swings as 1 + cos(5 t) while outside
    auto dynamics = MakeDynamics(world);
    double worst = 0;
    for (int ms = 0; ms <= 300; ++ms) {
      dynamics->AdvanceTo(AtMs(ms));
      const double x = dynamics->Read(0).position_m[0];
      worst = std::max(worst, std::abs(x - (1 + std::cos(5e-3 * ms))));
    }
    EXPECT_LT(worst, accuracy);
    EXPECT_GT(worst, accuracy / 1000) << "as if it took shorter steps than it need";
  }
}

// A force and a torque from an instant on, with all others busy: the closed form.
TEST_P(EachEngine, AStepResponseFollowsTheClosedFormBesideAnyNumberOfBodies) {
  constexpr double kMoment = 0.25;  // about z
  for (const int bodies : {1, 2, 96}) {
    auto dynamics = MakeDynamics(ManyBodies(bodies, GetParam()));
    const std::int64_t at_ns = 123'456'789;
    for (int i = 0; i < bodies; ++i) {
      const double newtons = 1.0 + i;
      dynamics->Apply(i, {.force_n = {newtons, 0, 0}, .torque_nm = {0, 0, 0.01}},
                      At(at_ns + 1'000'001 * i));
    }
    for (int ms = 10; ms <= 500; ms += 10) {
      dynamics->AdvanceTo(AtMs(ms));
      const auto states = StatesAt(*dynamics, 1'000'000LL * ms, bodies);
      for (int i = 0; i < bodies; ++i) {
        const BodyState& state = states[static_cast<std::size_t>(i)];
        const double t = std::max(0.0, 1e-3 * ms - 1e-9 * (at_ns + 1'000'001.0 * i));
        const double a = (1.0 + i) / kMass;
        ASSERT_NEAR(state.linear_velocity_mps[0], a * t, 1e-12) << "body " << i;
        ASSERT_NEAR(state.position_m[0], a * t * t / 2,
                    PositionTolerance(GetParam(), a, t) + 1e-12);
        ASSERT_NEAR(state.angular_velocity_radps[2], 0.01 / kMoment * t, 1e-12);
        // ODE turns by each step's last velocity.
        ASSERT_NEAR(state.orientation_xyzw[2], std::sin(0.01 / kMoment * t * t / 4),
                    GetParam().engine == EngineKind::kOde ? 1e-5 : 1e-7);
      }
    }
  }
}

}  // namespace
}  // namespace tcs
