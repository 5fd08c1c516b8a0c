#include "coordinator/host/switch_costs.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

constexpr UncheckedRuns kFromGate{.count = 4, .from_gate = 4}, kPreempted{.count = 4};

TEST(SwitchCosts, AreUnknownAtFirst) {
  const SwitchCosts costs;
  EXPECT_EQ(costs.Ns(true), 0);
  EXPECT_EQ(costs.Ns(false), 0);
}

// As in a run: what is known is not counted any more, and what is still stolen is the error.
TEST(SwitchCosts, AreFoundForEachKindByItself) {
  SwitchCosts costs;
  for (int i = 0; i < 300; ++i) {
    costs.Learn(kFromGate, 4 * (6'000 - costs.Ns(true)));
    costs.Learn(kPreempted, 4 * (3'500 - costs.Ns(false)));
  }
  EXPECT_NEAR(costs.Ns(true), 6'000, 1);
  EXPECT_NEAR(costs.Ns(false), 3'500, 1);
}

TEST(SwitchCosts, RunsOfBothKindsTellOfNeither) {
  SwitchCosts costs;
  costs.Learn({.count = 4, .from_gate = 1}, 1e6);
  EXPECT_EQ(costs.Ns(true), 0);
  EXPECT_EQ(costs.Ns(false), 0);
}

TEST(SwitchCosts, NoRunTellsNothing) {
  SwitchCosts costs;
  costs.Learn({}, 1e6);
  EXPECT_EQ(costs.Ns(true), 0);
  EXPECT_EQ(costs.Ns(false), 0);
}

TEST(SwitchCosts, ATheftOfSecondsIsNoSwitch) {
  SwitchCosts costs;
  costs.Learn(kPreempted, 4e9);
  EXPECT_LE(costs.Ns(false), SwitchCosts::kMostNs / 16);
  for (int i = 0; i < 100; ++i) costs.Learn(kPreempted, 4e9);
  EXPECT_EQ(costs.Ns(false), SwitchCosts::kMostNs);
}

TEST(SwitchCosts, OfPreemptionsAreNeverNegative) {
  SwitchCosts costs;
  costs.Learn(kPreempted, -4e9);
  EXPECT_EQ(costs.Ns(false), 0);
  EXPECT_EQ(costs.ExcusedNs(false), 0);
}

// The CPU clock counts more than the TSC: the thread went to its gate when its turn was over.
TEST(SwitchCosts, WaysToTheGateAreExcused) {
  SwitchCosts costs;
  for (int i = 0; i < 300; ++i) costs.Learn(kFromGate, 4 * (costs.ExcusedNs(true) - 1'500));
  EXPECT_NEAR(costs.ExcusedNs(true), 1'500, 1);
  EXPECT_EQ(costs.Ns(true), 0);
}

TEST(UncheckedRuns, CountsThoseFromTheGate) {
  UncheckedRuns runs;
  runs.Add(true);
  runs.Add(false);
  EXPECT_EQ(runs.count, 2);
  EXPECT_EQ(runs.from_gate, 1);
}

}  // namespace
}  // namespace tcs
