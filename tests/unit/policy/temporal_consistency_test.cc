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
  const auto predator = root.AddLeaf(), prey = root.AddLeaf();
  root.Update(predator, 500, 500);
  root.Update(prey, 300, 300);
  EXPECT_EQ(root.First(), prey);
  EXPECT_EQ(root.Least(), 300);
}

TEST(TemporalConsistency, TiesGoToTheLeafAddedFirst) {
  TemporalConsistency root(kDrift, kEnd);
  const auto predator = root.AddLeaf(), prey = root.AddLeaf();
  root.Update(prey, 300, 300);
  root.Update(predator, 300, 300);
  EXPECT_EQ(root.First(), predator);
}

TEST(TemporalConsistency, TiesGoToTheLeafThatActedLast) {
  TemporalConsistency root(kDrift, kEnd);
  const auto a = root.AddLeaf(), b = root.AddLeaf(), c = root.AddLeaf();
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
  const auto predator = root.AddLeaf(), prey = root.AddLeaf();
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
  const auto predator = root.AddLeaf(), prey = root.AddLeaf();
  root.Update(predator, 0, 0);
  root.Update(prey, 0, 10'000'000);
  EXPECT_EQ(root.Horizon(predator), 10'000'000 + kDrift);
  EXPECT_EQ(root.WriteSafe(predator), 10'000'000);
  EXPECT_EQ(root.Horizon(prey), kDrift);
}

TEST(TemporalConsistency, NobodyRunsFurtherAheadOfTheDynamicsThanTheDriftBound) {
  TemporalConsistency root(kDrift, kEnd);
  const auto predator = root.AddLeaf();
  root.Update(predator, 7'000'000, 7'000'000);
  EXPECT_EQ(root.DynamicsHorizon(), kNever);
  root.UpdateDynamics(7'000'000, 10'000'000);
  EXPECT_EQ(root.DynamicsHorizon(), 7'000'000 + kDrift);
}

TEST(TemporalConsistency, AReadWaitsForWhatTheDynamicsSendAtItsInstant) {
  TemporalConsistency root(kDrift, kEnd);
  const auto predator = root.AddLeaf();
  root.Update(predator, 0, 0);
  root.UpdateDynamics(0, 10'000'000);
  EXPECT_EQ(root.ReadSafe(predator), 9'999'999);
  root.UpdateDynamics(0, kNever);
  EXPECT_EQ(root.ReadSafe(predator), kNever);
}

TEST(TemporalConsistency, TheNextInputIsTheDynamicsOutputOrWhatAnotherLeafMaySend) {
  TemporalConsistency root(kDrift, kEnd);
  const auto predator = root.AddLeaf(), prey = root.AddLeaf();
  root.UpdateDynamics(0, 10'000'000);
  EXPECT_EQ(root.NextInput(predator), 10'000'000);
  root.Update(prey, 300, 300);
  EXPECT_EQ(root.NextInput(predator), 300);
}

TEST(TemporalConsistency, DriftIsTheLargestDifferenceSoFar) {
  TemporalConsistency root(kDrift, kEnd);
  const auto predator = root.AddLeaf(), prey = root.AddLeaf();
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
  const auto predator = root.AddLeaf();
  root.Update(predator, 1, 1);
  root.UpdateDynamics(1, kNever);
  EXPECT_EQ(root.Horizon(predator), kEnd);
  EXPECT_EQ(root.DynamicsHorizon(), kNever);
}

}  // namespace
}  // namespace tcs
