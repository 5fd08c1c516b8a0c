#include "coordinator/policy/temporal_consistency.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <span>

namespace tcs {
namespace {

constexpr VirtualTime operator""_ns(unsigned long long ns) {
  return RobotTime(static_cast<std::int64_t>(ns));
}

constexpr VirtualDuration kDrift = VirtualDuration::Milliseconds(1);
constexpr VirtualTime kEnd = 20'000'000'000_ns;

TEST(TemporalConsistency, TheLeastAdvancedLeafActs) {
  TemporalConsistency root(kDrift, kEnd);
  const auto predator = root.AddLeaf(0), prey = root.AddLeaf(1);
  root.Update(predator, 500_ns, 500_ns);
  root.Update(prey, 300_ns, 300_ns);
  EXPECT_EQ(root.First(), prey);
  EXPECT_EQ(root.Least(), 300_ns);
}

TEST(TemporalConsistency, TheSoonestAreToldInTheirOrder) {
  TemporalConsistency root(kDrift, kEnd);
  const auto a = root.AddLeaf(0), b = root.AddLeaf(1), c = root.AddLeaf(2), d = root.AddLeaf(3);
  root.Update(a, 0_ns, 700_ns);
  root.Update(b, 0_ns, 300_ns);
  root.Update(c, 0_ns, VirtualTime::Never());
  root.Update(d, 0_ns, 500_ns);
  std::array<TemporalConsistency::Leaf, 4> leaves{};
  EXPECT_EQ(root.Soonest(701_ns, leaves), 3u);
  EXPECT_THAT(std::span(leaves).first(3), testing::ElementsAre(b, d, a));
  EXPECT_EQ(root.Soonest(700_ns, leaves), 2u) << "those before that time";
  EXPECT_EQ(root.Soonest(VirtualTime::Never(), std::span(leaves).first(1)), 1u)
      << "as many as there is room for";
  EXPECT_EQ(leaves[0], b);
}

TEST(TemporalConsistency, TiesGoToTheLeafAddedFirst) {
  TemporalConsistency root(kDrift, kEnd);
  const auto predator = root.AddLeaf(0), prey = root.AddLeaf(1);
  root.Update(prey, 300_ns, 300_ns);
  root.Update(predator, 300_ns, 300_ns);
  EXPECT_EQ(root.First(), predator);
}

TEST(TemporalConsistency, TiesGoToTheLeafThatActedLast) {
  TemporalConsistency root(kDrift, kEnd);
  const auto a = root.AddLeaf(0), b = root.AddLeaf(1), c = root.AddLeaf(2);
  root.Update(a, 0_ns, VirtualTime::Never());
  root.Update(b, 0_ns, 0_ns);
  root.Update(c, 0_ns, VirtualTime::Never());
  ASSERT_EQ(root.First(), b);
  root.FirstActs();
  root.Update(b, 500_ns, 500_ns);
  root.Update(a, 0_ns, 500_ns);  // woken by b
  root.Update(c, 0_ns, 500_ns);
  EXPECT_EQ(root.First(), b);
  EXPECT_EQ(root.ReadSafe(b), 500_ns);
  root.Update(b, 501_ns, 501_ns);
  EXPECT_EQ(root.First(), a);
  EXPECT_EQ(root.ReadSafe(a), 500_ns);
}

TEST(TemporalConsistency, ABlockedLeafHoldsNobodyBack) {
  TemporalConsistency root(kDrift, kEnd);
  const auto predator = root.AddLeaf(0), prey = root.AddLeaf(1);
  root.Update(prey, 100_ns, VirtualTime::Never());
  root.Update(predator, 5'000'000_ns, 5'000'000_ns);
  EXPECT_EQ(root.First(), predator);
  EXPECT_EQ(root.Horizon(predator), kEnd);
  EXPECT_EQ(root.ReadSafe(predator), VirtualTime::Never());
  root.Update(predator, 5'000'000_ns, VirtualTime::Never());
  EXPECT_EQ(root.First(), -1);
}

TEST(TemporalConsistency, AnIdleLeafHoldsOthersBackOnlyFromItsWakeUpOn) {
  TemporalConsistency root(kDrift, kEnd);
  const auto predator = root.AddLeaf(0), prey = root.AddLeaf(1);
  root.Update(predator, 0_ns, 0_ns);
  root.Update(prey, 0_ns, 10'000'000_ns);
  EXPECT_EQ(root.Horizon(predator), 10'000'000_ns + kDrift);
  EXPECT_EQ(root.WriteSafe(predator), 10'000'000_ns);
  EXPECT_EQ(root.Horizon(prey), 0_ns + kDrift);
}

TEST(TemporalConsistency, NobodyRunsFurtherAheadOfTheDynamicsThanTheDriftBound) {
  TemporalConsistency root(kDrift, kEnd);
  const auto predator = root.AddLeaf(0);
  root.Update(predator, 7'000'000_ns, 7'000'000_ns);
  EXPECT_EQ(root.DynamicsHorizon(), VirtualTime::Never());
  root.UpdateDynamics(7'000'000_ns, 10'000'000_ns);
  EXPECT_EQ(root.DynamicsHorizon(), 7'000'000_ns + kDrift);
}

TEST(TemporalConsistency, NobodyActsFurtherBehindOthersThanTheDriftBound) {
  TemporalConsistency root(kDrift, kEnd);
  const auto predator = root.AddLeaf(0), prey = root.AddLeaf(1);
  root.Update(prey, 0_ns, 7'000'000_ns);
  root.Update(predator, 8'000'000_ns, 8'000'000_ns);
  root.Update(prey, 0_ns, 6'000'000_ns);
  EXPECT_EQ(root.First(), prey);
  EXPECT_EQ(root.Least(), 7'000'000_ns);
  root.Update(prey, 0_ns, 7'500'000_ns);
  EXPECT_EQ(root.Least(), 7'500'000_ns);
  root.Update(prey, 7'500'000_ns, 7'500'000_ns);
  EXPECT_EQ(root.drift(), kDrift);
}

TEST(TemporalConsistency, AReadWaitsForWhatTheDynamicsSendAtItsInstant) {
  TemporalConsistency root(kDrift, kEnd);
  const auto predator = root.AddLeaf(0);
  root.Update(predator, 0_ns, 0_ns);
  root.UpdateDynamics(0_ns, 10'000'000_ns);
  EXPECT_EQ(root.ReadSafe(predator), 9'999'999_ns);
  root.UpdateDynamics(0_ns, VirtualTime::Never());
  EXPECT_EQ(root.ReadSafe(predator), VirtualTime::Never());
}

TEST(TemporalConsistency, InputComesFromOtherLeavesFromOtherComputersAndFromTheDynamics) {
  TemporalConsistency root(kDrift, kEnd);
  const auto one = root.AddLeaf(0), two = root.AddLeaf(0), prey = root.AddLeaf(1);
  EXPECT_EQ(root.NextOutput(), VirtualTime::Never());
  root.UpdateDynamics(0_ns, 10'000'000_ns);
  EXPECT_EQ(root.NextOutput(), 10'000'000_ns);
  root.Update(two, 200_ns, 200_ns);
  root.Update(prey, 300_ns, 300_ns);
  EXPECT_EQ(root.NextInput(one), 200_ns);
  EXPECT_EQ(root.NextInputFromOutside(one), 300_ns);
  EXPECT_EQ(root.NextInputFromOutside(prey), 200_ns);
  root.Update(prey, 300_ns, VirtualTime::Never());
  EXPECT_EQ(root.NextInputFromOutside(one), VirtualTime::Never());
}

TEST(TemporalConsistency, ALeafGivesWayToOthersOfItsInstantAndToNoneAtTheNext) {
  TemporalConsistency root(kDrift, kEnd);
  const auto drone = root.AddLeaf(0), ground = root.AddLeaf(1);
  root.Update(drone, 300_ns, 300_ns);
  root.Update(ground, 0_ns, 300_ns);
  ASSERT_EQ(root.First(), drone);
  root.GiveWay(drone);
  EXPECT_TRUE(root.HasGivenWay(drone));
  EXPECT_EQ(root.First(), ground);
  EXPECT_EQ(root.ReadSafe(ground), 300_ns);
  root.Update(ground, 300_ns, 400_ns);
  EXPECT_EQ(root.First(), drone);
  root.Update(drone, 400_ns, 400_ns);
  EXPECT_FALSE(root.HasGivenWay(drone));
  EXPECT_EQ(root.First(), drone);
}

TEST(TemporalConsistency, WhereAllGiveWayOneActsAllTheSame) {
  TemporalConsistency root(kDrift, kEnd);
  const auto drone = root.AddLeaf(0), ground = root.AddLeaf(1);
  root.Update(drone, 300_ns, 300_ns);
  root.Update(ground, 300_ns, 300_ns);
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
  root.Update(ground, 0_ns, VirtualTime::Never());
  root.Update(drone, 0_ns + 5 * kDrift, 0_ns + 5 * kDrift);
  EXPECT_EQ(root.EarliestWake(), 0_ns + 4 * kDrift);
  root.Update(ground, 0_ns, root.EarliestWake());
  EXPECT_EQ(root.Horizon(drone), 0_ns + 5 * kDrift);
}

TEST(TemporalConsistency, DriftIsTheLargestDifferenceSoFar) {
  TemporalConsistency root(kDrift, kEnd);
  const auto predator = root.AddLeaf(0), prey = root.AddLeaf(1);
  root.Update(predator, 0_ns, 0_ns);
  root.Update(prey, 0_ns, 0_ns);
  root.UpdateDynamics(0_ns, VirtualTime::Never());
  root.Update(predator, 900'000_ns, 900'000_ns);
  EXPECT_EQ(root.drift(), VirtualNs(900'000));
  root.Update(prey, 800'000_ns, 800'000_ns);
  root.UpdateDynamics(800'000_ns, VirtualTime::Never());
  EXPECT_EQ(root.drift(), VirtualNs(900'000));
}

TEST(TemporalConsistency, TheRunsEndBoundsEveryHorizonWithoutOverflow) {
  TemporalConsistency root(VirtualNs(VirtualTime::Never().ns()), kEnd);
  const auto predator = root.AddLeaf(0);
  root.Update(predator, 1_ns, 1_ns);
  root.UpdateDynamics(1_ns, VirtualTime::Never());
  EXPECT_EQ(root.Horizon(predator), kEnd);
  EXPECT_EQ(root.DynamicsHorizon(), VirtualTime::Never());
}

TEST(TemporalConsistency, ARunMayGetAnotherEndThatTheDynamicsDoNotShare) {
  TemporalConsistency root(kDrift, kEnd);
  const auto leaf = root.AddLeaf(0);
  root.Update(leaf, kEnd, kEnd);
  root.UpdateDynamics(kEnd, kEnd + VirtualNs(10));
  EXPECT_EQ(root.Horizon(leaf), kEnd);
  root.EndDynamics();
  root.EndAt(kEnd + VirtualNs(100));
  EXPECT_EQ(root.Horizon(leaf), kEnd + VirtualNs(100));
  EXPECT_EQ(root.DynamicsHorizon(), VirtualTime::Never());
  EXPECT_EQ(root.NextOutput(), VirtualTime::Never());
  EXPECT_EQ(root.ReadSafe(leaf), VirtualTime::Never());
}

TEST(TemporalConsistency, WhoDoesNothingForAWhileLetsOthersGoFirst) {
  TemporalConsistency root(kDrift, kEnd);
  const auto ahead = root.AddLeaf(0), other = root.AddLeaf(1);
  root.Update(ahead, 300_ns, 300_ns, 700_ns);
  root.Update(other, 500_ns, 500_ns);
  EXPECT_EQ(root.First(), other);
  EXPECT_EQ(root.Least(), 500_ns);
  EXPECT_EQ(root.NextInput(other), 700_ns);
  EXPECT_EQ(root.ReadSafe(other), 700_ns);
  root.Update(ahead, 300_ns, 300_ns);
  EXPECT_EQ(root.First(), ahead) << "something else has come up";
  EXPECT_EQ(root.NextInput(other), 300_ns);
}

TEST(TemporalConsistency, NobodyGetsFurtherAwayFromOneThatDoesNothingForAWhile) {
  TemporalConsistency root(kDrift, kEnd);
  const auto ahead = root.AddLeaf(0), other = root.AddLeaf(1);
  root.Update(ahead, 300_ns, 300_ns, 700_ns);
  root.Update(other, 500_ns, 500_ns);
  EXPECT_EQ(root.Horizon(other), 300_ns + kDrift);
  EXPECT_EQ(root.Horizon(ahead), 500_ns + kDrift) << "not from itself";
  root.Update(other, 600_ns, 600_ns);
  EXPECT_EQ(root.drift(), VirtualNs(300));
  root.Update(ahead, 400_ns, 400_ns, 300_ns);
  EXPECT_EQ(root.Horizon(other), 400_ns + kDrift) << "a time that is over is none";
  EXPECT_EQ(root.First(), ahead);
}

TEST(TemporalConsistency, WhatIsLocalToAComputerDoesNotDependOnOthers) {
  TemporalConsistency root(kDrift, kEnd);
  const auto other = root.AddLeaf(1), reader = root.AddLeaf(2), third = root.AddLeaf(3);
  root.Update(other, 300_ns, 300_ns);
  root.Update(reader, 500_ns, 500_ns);
  root.Update(third, 0_ns, VirtualTime::Never());
  EXPECT_EQ(root.ReadSafe(reader), 300_ns);
  EXPECT_EQ(root.LocalReadSafe(reader), VirtualTime::Never());
}

TEST(TemporalConsistency, WhatIsLocalDependsOnTheDynamics) {
  TemporalConsistency root(kDrift, kEnd);
  const auto reader = root.AddLeaf(1);
  root.Update(reader, 500_ns, 500_ns);
  root.UpdateDynamics(400_ns, 1000_ns);
  EXPECT_EQ(root.LocalReadSafe(reader), 999_ns) << "what they send at 1000 is there at 1000";
}

TEST(TemporalConsistency, WhatIsLocalDependsOnTheComputersOtherCores) {
  TemporalConsistency root(kDrift, kEnd);
  const auto before = root.AddLeaf(1), first = root.AddLeaf(2), second = root.AddLeaf(2);
  root.Update(before, 300_ns, 300_ns);
  root.Update(first, 500_ns, 500_ns);
  root.Update(second, 450_ns, 450_ns);
  EXPECT_EQ(root.LocalReadSafe(first), 450_ns);
  EXPECT_EQ(root.LocalReadSafe(second), 500_ns);
  root.Update(second, 450_ns, 700_ns);
  EXPECT_EQ(root.LocalReadSafe(first), 450_ns) << "the other computer may wake it at 300";
  root.Update(before, 300_ns, 600_ns);
  EXPECT_EQ(root.LocalReadSafe(first), 600_ns);
  root.Update(before, 300_ns, VirtualTime::Never());
  EXPECT_EQ(root.LocalReadSafe(first), 700_ns);
}

TEST(TemporalConsistency, NoLeafsProgressGoesBack) {
  TemporalConsistency root(kDrift, kEnd);
  const auto leaf = root.AddLeaf(0);
  root.Update(leaf, 500_ns, 500_ns);
  root.Update(leaf, 500_ns, 700_ns);
  EXPECT_DEATH(root.Update(leaf, 499_ns, 700_ns), "a bug in tcs");
}

}  // namespace
}  // namespace tcs
