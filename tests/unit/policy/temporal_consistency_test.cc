#include "coordinator/policy/temporal_consistency.h"

#include <gtest/gtest.h>

#include "shm/layout.h"

namespace tcs {
namespace {

constexpr std::int64_t kDrift = 1'000'000;
constexpr std::int64_t kEnd = 20'000'000'000;
constexpr std::int64_t kNever = shm::kNeverNs;

TEST(TemporalConsistency, TheLeastAdvancedLeafActs) {
  TemporalConsistency root(kDrift, kEnd);
  const auto predator = root.AddLeaf(0), prey = root.AddLeaf(1);
  root.Update(predator, 500, 500);
  root.Update(prey, 300, 300);
  EXPECT_EQ(root.First(), prey);
  EXPECT_EQ(root.Least(), 300);
}

TEST(TemporalConsistency, TiesGoToTheLeafAddedFirst) {
  TemporalConsistency root(kDrift, kEnd);
  const auto predator = root.AddLeaf(0), prey = root.AddLeaf(1);
  root.Update(prey, 300, 300);
  root.Update(predator, 300, 300);
  EXPECT_EQ(root.First(), predator);
}

TEST(TemporalConsistency, TiesGoToTheLeafThatActedLast) {
  TemporalConsistency root(kDrift, kEnd);
  const auto a = root.AddLeaf(0), b = root.AddLeaf(1), c = root.AddLeaf(2);
  root.Update(a, 0, shm::kNeverNs);
  root.Update(b, 0, 0);
  root.Update(c, 0, shm::kNeverNs);
  ASSERT_EQ(root.First(), b);
  root.FirstActs();
  root.Update(b, 500, 500);
  root.Update(a, 0, 500);  // woken by b
  root.Update(c, 0, 500);
  EXPECT_EQ(root.First(), b);
  EXPECT_EQ(root.ReadSafe(b), 500);
  root.Update(b, 501, 501);
  EXPECT_EQ(root.First(), a);
  EXPECT_EQ(root.ReadSafe(a), 500);
}

TEST(TemporalConsistency, ABlockedLeafHoldsNobodyBack) {
  TemporalConsistency root(kDrift, kEnd);
  const auto predator = root.AddLeaf(0), prey = root.AddLeaf(1);
  root.Update(prey, 100, kNever);
  root.Update(predator, 5'000'000, 5'000'000);
  EXPECT_EQ(root.First(), predator);
  EXPECT_EQ(root.Horizon(predator), kEnd);
  EXPECT_EQ(root.ReadSafe(predator), kNever);
  root.Update(predator, 5'000'000, kNever);
  EXPECT_EQ(root.First(), -1);
}

TEST(TemporalConsistency, AnIdleLeafHoldsOthersBackOnlyFromItsWakeUpOn) {
  TemporalConsistency root(kDrift, kEnd);
  const auto predator = root.AddLeaf(0), prey = root.AddLeaf(1);
  root.Update(predator, 0, 0);
  root.Update(prey, 0, 10'000'000);
  EXPECT_EQ(root.Horizon(predator), 10'000'000 + kDrift);
  EXPECT_EQ(root.WriteSafe(predator), 10'000'000);
  EXPECT_EQ(root.Horizon(prey), kDrift);
}

TEST(TemporalConsistency, NobodyRunsFurtherAheadOfTheDynamicsThanTheDriftBound) {
  TemporalConsistency root(kDrift, kEnd);
  const auto predator = root.AddLeaf(0);
  root.Update(predator, 7'000'000, 7'000'000);
  EXPECT_EQ(root.DynamicsHorizon(), kNever);
  root.UpdateDynamics(7'000'000, 10'000'000);
  EXPECT_EQ(root.DynamicsHorizon(), 7'000'000 + kDrift);
}

TEST(TemporalConsistency, NobodyActsFurtherBehindOthersThanTheDriftBound) {
  TemporalConsistency root(kDrift, kEnd);
  const auto predator = root.AddLeaf(0), prey = root.AddLeaf(1);
  root.Update(prey, 0, 7'000'000);
  root.Update(predator, 8'000'000, 8'000'000);
  root.Update(prey, 0, 6'000'000);
  EXPECT_EQ(root.First(), prey);
  EXPECT_EQ(root.Least(), 7'000'000);
  root.Update(prey, 0, 7'500'000);
  EXPECT_EQ(root.Least(), 7'500'000);
  root.Update(prey, 7'500'000, 7'500'000);
  EXPECT_EQ(root.drift_ns(), kDrift);
}

TEST(TemporalConsistency, AReadWaitsForWhatTheDynamicsSendAtItsInstant) {
  TemporalConsistency root(kDrift, kEnd);
  const auto predator = root.AddLeaf(0);
  root.Update(predator, 0, 0);
  root.UpdateDynamics(0, 10'000'000);
  EXPECT_EQ(root.ReadSafe(predator), 9'999'999);
  root.UpdateDynamics(0, kNever);
  EXPECT_EQ(root.ReadSafe(predator), kNever);
}

TEST(TemporalConsistency, InputComesFromOtherLeavesFromOtherComputersAndFromTheDynamics) {
  TemporalConsistency root(kDrift, kEnd);
  const auto one = root.AddLeaf(0), two = root.AddLeaf(0), prey = root.AddLeaf(1);
  EXPECT_EQ(root.NextOutput(), kNever);
  root.UpdateDynamics(0, 10'000'000);
  EXPECT_EQ(root.NextOutput(), 10'000'000);
  root.Update(two, 200, 200);
  root.Update(prey, 300, 300);
  EXPECT_EQ(root.NextInput(one), 200);
  EXPECT_EQ(root.NextInputFromOutside(one), 300);
  EXPECT_EQ(root.NextInputFromOutside(prey), 200);
  root.Update(prey, 300, kNever);
  EXPECT_EQ(root.NextInputFromOutside(one), kNever);
}

TEST(TemporalConsistency, ALeafGivesWayToOthersOfItsInstantAndToNoneAtTheNext) {
  TemporalConsistency root(kDrift, kEnd);
  const auto drone = root.AddLeaf(0), ground = root.AddLeaf(1);
  root.Update(drone, 300, 300);
  root.Update(ground, 0, 300);
  ASSERT_EQ(root.First(), drone);
  root.GiveWay(drone);
  EXPECT_TRUE(root.HasGivenWay(drone));
  EXPECT_EQ(root.First(), ground);
  EXPECT_EQ(root.ReadSafe(ground), 300);
  root.Update(ground, 300, 400);
  EXPECT_EQ(root.First(), drone);
  root.Update(drone, 400, 400);
  EXPECT_FALSE(root.HasGivenWay(drone));
  EXPECT_EQ(root.First(), drone);
}

TEST(TemporalConsistency, WhereAllGiveWayOneActsAllTheSame) {
  TemporalConsistency root(kDrift, kEnd);
  const auto drone = root.AddLeaf(0), ground = root.AddLeaf(1);
  root.Update(drone, 300, 300);
  root.Update(ground, 300, 300);
  root.GiveWay(drone);
  root.GiveWay(ground);
  EXPECT_EQ(root.First(), drone);
  root.FirstActs();
  EXPECT_FALSE(root.HasGivenWay(drone));
  EXPECT_EQ(root.First(), drone);
}

TEST(TemporalConsistency, NobodyIsWokenFurtherBehindTheOthersThanTheDriftBound) {
  TemporalConsistency root(kDrift, kEnd);
  const auto drone = root.AddLeaf(0), ground = root.AddLeaf(1);
  root.Update(ground, 0, kNever);
  root.Update(drone, 5 * kDrift, 5 * kDrift);
  EXPECT_EQ(root.EarliestWake(), 4 * kDrift);
  root.Update(ground, 0, root.EarliestWake());
  EXPECT_EQ(root.Horizon(drone), 5 * kDrift);
}

TEST(TemporalConsistency, DriftIsTheLargestDifferenceSoFar) {
  TemporalConsistency root(kDrift, kEnd);
  const auto predator = root.AddLeaf(0), prey = root.AddLeaf(1);
  root.Update(predator, 0, 0);
  root.Update(prey, 0, 0);
  root.UpdateDynamics(0, kNever);
  root.Update(predator, 900'000, 900'000);
  EXPECT_EQ(root.drift_ns(), 900'000);
  root.Update(prey, 800'000, 800'000);
  root.UpdateDynamics(800'000, kNever);
  EXPECT_EQ(root.drift_ns(), 900'000);
}

TEST(TemporalConsistency, TheRunsEndBoundsEveryHorizonWithoutOverflow) {
  TemporalConsistency root(kNever, kEnd);
  const auto predator = root.AddLeaf(0);
  root.Update(predator, 1, 1);
  root.UpdateDynamics(1, kNever);
  EXPECT_EQ(root.Horizon(predator), kEnd);
  EXPECT_EQ(root.DynamicsHorizon(), kNever);
}

TEST(TemporalConsistency, ARunMayGetAnotherEndThatTheDynamicsDoNotShare) {
  TemporalConsistency root(kDrift, kEnd);
  const auto leaf = root.AddLeaf(0);
  root.Update(leaf, kEnd, kEnd);
  root.UpdateDynamics(kEnd, kEnd + 10);
  EXPECT_EQ(root.Horizon(leaf), kEnd);
  root.EndDynamics();
  root.EndAt(kEnd + 100);
  EXPECT_EQ(root.Horizon(leaf), kEnd + 100);
  EXPECT_EQ(root.DynamicsHorizon(), kNever);
  EXPECT_EQ(root.NextOutput(), kNever);
  EXPECT_EQ(root.ReadSafe(leaf), kNever);
}

TEST(TemporalConsistency, WhoDoesNothingForAWhileLetsOthersGoFirst) {
  TemporalConsistency root(kDrift, kEnd);
  const auto ahead = root.AddLeaf(0), other = root.AddLeaf(1);
  root.Update(ahead, 300, 300, 700);
  root.Update(other, 500, 500);
  EXPECT_EQ(root.First(), other);
  EXPECT_EQ(root.Least(), 500);
  EXPECT_EQ(root.NextInput(other), 700);
  EXPECT_EQ(root.ReadSafe(other), 700);
  root.Update(ahead, 300, 300);
  EXPECT_EQ(root.First(), ahead) << "something else has come up";
  EXPECT_EQ(root.NextInput(other), 300);
}

TEST(TemporalConsistency, NobodyGetsFurtherAwayFromOneThatDoesNothingForAWhile) {
  TemporalConsistency root(kDrift, kEnd);
  const auto ahead = root.AddLeaf(0), other = root.AddLeaf(1);
  root.Update(ahead, 300, 300, 700);
  root.Update(other, 500, 500);
  EXPECT_EQ(root.Horizon(other), 300 + kDrift);
  EXPECT_EQ(root.Horizon(ahead), 500 + kDrift) << "not from itself";
  root.Update(other, 600, 600);
  EXPECT_EQ(root.drift_ns(), 300);
  root.Update(ahead, 400, 400, 300);
  EXPECT_EQ(root.Horizon(other), 400 + kDrift) << "a time that is over is none";
  EXPECT_EQ(root.First(), ahead);
}

TEST(TemporalConsistency, WhatIsLocalToAComputerDoesNotDependOnOthers) {
  TemporalConsistency root(kDrift, kEnd);
  const auto other = root.AddLeaf(1), reader = root.AddLeaf(2), third = root.AddLeaf(3);
  root.Update(other, 300, 300);
  root.Update(reader, 500, 500);
  root.Update(third, 0, kNever);
  EXPECT_EQ(root.ReadSafe(reader), 300);
  EXPECT_EQ(root.LocalReadSafe(reader), kNever);
}

TEST(TemporalConsistency, WhatIsLocalDependsOnTheDynamics) {
  TemporalConsistency root(kDrift, kEnd);
  const auto reader = root.AddLeaf(1);
  root.Update(reader, 500, 500);
  root.UpdateDynamics(400, 1000);
  EXPECT_EQ(root.LocalReadSafe(reader), 999) << "what they send at 1000 is there at 1000";
}

TEST(TemporalConsistency, WhatIsLocalDependsOnTheComputersOtherCores) {
  TemporalConsistency root(kDrift, kEnd);
  const auto before = root.AddLeaf(1), first = root.AddLeaf(2), second = root.AddLeaf(2);
  root.Update(before, 300, 300);
  root.Update(first, 500, 500);
  root.Update(second, 450, 450);
  EXPECT_EQ(root.LocalReadSafe(first), 450);
  EXPECT_EQ(root.LocalReadSafe(second), 500);
  root.Update(second, 450, 700);
  EXPECT_EQ(root.LocalReadSafe(first), 450) << "the other computer may wake it at 300";
  root.Update(before, 300, 600);
  EXPECT_EQ(root.LocalReadSafe(first), 600);
  root.Update(before, 300, kNever);
  EXPECT_EQ(root.LocalReadSafe(first), 700);
}

TEST(TemporalConsistency, NoLeafsProgressGoesBack) {
  TemporalConsistency root(kDrift, kEnd);
  const auto leaf = root.AddLeaf(0);
  root.Update(leaf, 500, 500);
  root.Update(leaf, 500, 700);
  EXPECT_DEATH(root.Update(leaf, 499, 700), "a bug in tcs");
}

}  // namespace
}  // namespace tcs
