// Save and Restore.
#include "tests/unit/dynamics/test_worlds.h"

namespace tcs {
namespace {

constexpr int kBusyBodies = 2;  // of BusyWorld

// Some further run: long and short pieces, commands between and in advance. Returns every state on
// the way.
std::vector<std::vector<BodyState>> GoOn(Dynamics& dynamics) {
  std::vector<std::vector<BodyState>> states;
  const std::int64_t start = dynamics.Now().ns();
  std::int64_t ns = start;
  for (int i = 1; i <= 40; ++i) {
    dynamics.Apply(i % kBusyBodies, {.force_n = {1.0 * (i % 3), 0, 2}, .torque_nm = {0.01, 0, 0}},
                   At(ns + 1'234'567));
    ns += i % 4 == 0 ? 1'000'000 : 37'000'001;
    dynamics.AdvanceTo(At(ns));
    states.push_back(ReadAll(dynamics, kBusyBodies));
  }
  return states;
}

class Checkpoints : public EveryIntegrator {};

TEST_P(Checkpoints, SavingDoesNotChangeTheRun) {
  auto saved = MakeDynamics(BusyWorld(GetParam()));
  auto plain = MakeDynamics(BusyWorld(GetParam()));
  for (int i = 1; i <= 50; ++i) {
    auto checkpoint = saved->Save();
    saved->AdvanceTo(AtMs(23 * i));
    plain->AdvanceTo(AtMs(23 * i));
    ASSERT_TRUE(SameBits(ReadAll(*saved, kBusyBodies), ReadAll(*plain, kBusyBodies)))
        << "at " << 23 * i;
  }
}

TEST_P(Checkpoints, RestoringRepeatsTheOriginalRunBitwiseAnyNumberOfTimes) {
  auto dynamics = MakeDynamics(BusyWorld(GetParam()));
  GoOn(*dynamics);
  // One wrench acts, one is still to come.
  dynamics->Apply(0, {.force_n = {3, 0, 0}, .torque_nm = {}},
                  At(dynamics->Now().ns() + 50'000'000));
  const VirtualTime time = dynamics->Now();
  const auto state = ReadAll(*dynamics, kBusyBodies);
  const auto checkpoint = dynamics->Save();
  const auto original = GoOn(*dynamics);
  for (int replay = 0; replay < 2; ++replay) {
    dynamics->Restore(*checkpoint);
    ASSERT_EQ(dynamics->Now(), time);
    ASSERT_TRUE(SameBits(ReadAll(*dynamics, kBusyBodies), state));
    const auto repeated = GoOn(*dynamics);
    for (std::size_t i = 0; i < original.size(); ++i) {
      ASSERT_TRUE(SameBits(original[i], repeated[i])) << "replay " << replay << ", piece " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Dynamics, Checkpoints, testing::ValuesIn(FixedAndAdaptive()), NameOfParam);

class Checkpoint : public EveryEngine {};
class CheckpointDeathTest : public EveryEngine {};

INSTANTIATE_TEST_SUITE_P(Engines, Checkpoint, testing::ValuesIn(Engines()), NameOfEngine);
INSTANTIATE_TEST_SUITE_P(Engines, CheckpointDeathTest, testing::ValuesIn(Engines()), NameOfEngine);

TEST_P(Checkpoint, BringsBackTheCommandsThatWerePending) {
  auto dynamics = MakeDynamics(OneBody(GetParam()));
  dynamics->Apply(0, {.force_n = {2, 0, 0}, .torque_nm = {}}, AtMs(10));
  const auto checkpoint = dynamics->Save();
  dynamics->AdvanceTo(AtMs(20));
  dynamics->Apply(0, {.force_n = {100, 0, 0}, .torque_nm = {}},
                  AtMs(30));  // of the branch left behind
  dynamics->Restore(*checkpoint);
  EXPECT_EQ(dynamics->Read(0).linear_velocity_mps[0], 0);
  dynamics->AdvanceTo(AtMs(110));
  EXPECT_NEAR(dynamics->Read(0).linear_velocity_mps[0], 2 / 2.0 * 0.1, 1e-14);
}

TEST_P(Checkpoint, OfTheStartCanBeRestored) {
  auto dynamics = MakeDynamics(BusyWorld(GetParam()));
  const auto checkpoint = dynamics->Save();
  const auto original = GoOn(*dynamics);
  dynamics->Restore(*checkpoint);
  EXPECT_TRUE(SameBits(original.back(), GoOn(*dynamics).back()));
}

TEST_P(CheckpointDeathTest, BelongsToTheDynamicsThatSavedIt) {
  auto dynamics = MakeDynamics(OneBody(GetParam()));
  auto other = MakeDynamics(OneBody(GetParam()));
  const auto checkpoint = dynamics->Save();
  EXPECT_DEATH(other->Restore(*checkpoint), "a checkpoint belongs to the dynamics that saved it");
}

}  // namespace
}  // namespace tcs
