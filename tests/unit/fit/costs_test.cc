#include "coordinator/fit/costs.h"

#include <gtest/gtest.h>

#include <random>

namespace tcs::fit {
namespace {

Work SumOf(const std::vector<Work>& activations) {
  Work sum;
  for (const Work& w : activations) {
    sum.charged_ns += w.charged_ns;
    sum.calls += w.calls;
    sum.allocations += w.allocations;
  }
  return sum;
}

Work At(double call_ns, double allocation_ns, double calls, double allocations) {
  return {call_ns * calls + allocation_ns * allocations, calls, allocations};
}

TEST(FitCosts, FindsTheCostsThatTheChargesAreMadeOf) {
  const std::vector<Work> activations{At(700, 1900, 9, 4), At(700, 1900, 15, 0),
                                      At(700, 1900, 3, 2000), At(700, 1900, 100, 1)};
  const Costs costs = FitCosts(SumOf(activations), activations);
  EXPECT_EQ(costs.call_ns, 700);
  EXPECT_EQ(costs.allocation_ns, 1900);
  EXPECT_DOUBLE_EQ(MisfitOf(costs, activations), 0);
}

// A page fault, an interrupt: with least squares one such activation would decide.
TEST(FitCosts, AFewThatLastedLongByChanceDoNotMatterButForTheSum) {
  std::mt19937 random(1);
  std::vector<Work> activations;
  for (int i = 0; i < 1000; ++i) {
    activations.push_back(At(700, 1900, random() % 20, random() % 50));
  }
  const double undisturbed = SumOf(activations).charged_ns;
  for (const std::size_t i : {3u, 500u, 900u}) activations[i].charged_ns += 100'000;
  const Work whole = SumOf(activations);
  const Costs costs = FitCosts(whole, activations);
  ASSERT_TRUE(costs.call_ns && costs.allocation_ns);
  EXPECT_NEAR(static_cast<double>(*costs.allocation_ns), 1900, 40);
  EXPECT_NEAR(static_cast<double>(*costs.call_ns), 700, 120);
  EXPECT_NEAR(costs.ChargeOf(whole) / whole.charged_ns, 1, 1e-3);
  EXPECT_GT(costs.ChargeOf(whole), undisturbed);
}

TEST(FitCosts, TheWholeRunIsMetThoughMostOfItIsInNoActivation) {
  const std::vector<Work> activations{At(700, 1900, 10, 10), At(700, 1900, 20, 10)};
  const Work whole{10'000'000, 1000, 2000};
  const Costs costs = FitCosts(whole, activations);
  EXPECT_NEAR(costs.ChargeOf(whole), whole.charged_ns, 1000);
}

TEST(FitCosts, WhatGoesTogetherCannotBeToldApartAndKeepsTheUsualProportion) {
  const std::vector<Work> activations{{3'000, 4, 2}, {6'000, 8, 4}, {1'500, 2, 1}};
  const Costs costs = FitCosts(SumOf(activations), activations);
  EXPECT_EQ(costs.call_ns, 375);
  EXPECT_EQ(costs.allocation_ns, 750);
}

TEST(FitCosts, NoneIsBelowNothing) {
  // The more it allocates, the less it is charged.
  const std::vector<Work> activations{{1'000, 1, 50}, {51'000, 50, 1}, {26'000, 25, 25}};
  const Costs costs = FitCosts(SumOf(activations), activations);
  EXPECT_EQ(costs.allocation_ns, 0);
  EXPECT_NEAR(costs.ChargeOf(SumOf(activations)), 78'000, 100);
  // And the other way round: a scenario takes no call that costs nothing.
  const std::vector<Work> mirrored{{500, 50, 1}, {51'000, 1, 50}, {26'000, 25, 25}};
  const Costs others = FitCosts(SumOf(mirrored), mirrored);
  EXPECT_EQ(others.call_ns, 1);
  EXPECT_NEAR(others.ChargeOf(SumOf(mirrored)), 77'500, 100);
}

TEST(FitCosts, WithoutAllocationsCallsCostAllAndTheOtherWayRound) {
  const Costs calls = FitCosts({10'000, 4, 0}, {{10'000, 4, 0}});
  EXPECT_EQ(calls.call_ns, 2500);
  EXPECT_FALSE(calls.allocation_ns.has_value());
  const Costs allocations = FitCosts({10'000, 0, 4}, {{10'000, 0, 4}});
  EXPECT_FALSE(allocations.call_ns.has_value());
  EXPECT_EQ(allocations.allocation_ns, 2500);
}

TEST(FitCosts, OneActivationOrNoneIsMetBySums) {
  for (const auto& activations : {std::vector<Work>{}, {{9'000, 5, 2}}}) {
    const Costs costs = FitCosts({9'000, 5, 2}, activations);
    EXPECT_EQ(costs.call_ns, 1000);
    EXPECT_EQ(costs.allocation_ns, 2000);
  }
}

TEST(FitCosts, WhoDidNothingHasNone) {
  for (const double charged_ns : {0.0, 5'000'000.0}) {
    const Costs costs = FitCosts({charged_ns, 0, 0}, {{charged_ns, 0, 0}});
    EXPECT_FALSE(costs.call_ns.has_value());
    EXPECT_FALSE(costs.allocation_ns.has_value());
    EXPECT_DOUBLE_EQ(costs.ChargeOf({1, 2, 3}), 0);
  }
}

// No charge at all: fixed accounting charges at least a nanosecond a call.
TEST(FitCosts, WhatWasNotChargedCostsNextToNothing) {
  const Costs costs = FitCosts({0, 100, 50}, {{0, 100, 50}});
  EXPECT_EQ(costs.call_ns, 1);
  EXPECT_EQ(costs.allocation_ns, 0);
}

TEST(Misfit, IsWhatIsInTheWrongActivations) {
  Costs costs;
  costs.call_ns = 100;
  EXPECT_DOUBLE_EQ(MisfitOf(costs, {{500, 10, 0}, {1'500, 10, 0}}), 0.5);
  EXPECT_DOUBLE_EQ(MisfitOf(costs, {}), 0);
  EXPECT_DOUBLE_EQ(MisfitOf(costs, {{0, 10, 0}}), 0);
}

}  // namespace
}  // namespace tcs::fit
