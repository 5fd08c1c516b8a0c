#include "coordinator/compare/rank_sum.h"

#include <gtest/gtest.h>

#include <random>

namespace tcs::compare {
namespace {

// The values are those of R's wilcox.test(exact = TRUE), and of coin's for ties.
TEST(RankSum, IsExactForFewValues) {
  EXPECT_NEAR(RankSumProbability({1, 2, 3}, {4, 5, 6}), 0.1, 1e-12);
  EXPECT_NEAR(RankSumProbability({1, 2, 3, 4, 5}, {6, 7, 8, 9, 10}), 2.0 / 252, 1e-12);
  EXPECT_NEAR(RankSumProbability({0.80, 0.83, 1.89, 1.04, 1.45, 1.38, 1.91, 1.64, 0.73, 1.46},
                                 {1.15, 0.88, 0.90, 0.74, 1.21}),
              0.2544122544, 1e-9);  // R's own example
}

TEST(RankSum, TiesShareTheirRanks) {
  // Of the 20 ways to choose three of {1, 1, 1, 1, 1, 2}, ten have the 2.
  EXPECT_NEAR(RankSumProbability({1, 1, 1}, {1, 1, 2}), 1, 1e-12);
  EXPECT_NEAR(RankSumProbability({0, 0, 0, 0}, {1, 1, 1, 1}), 2.0 / 70, 1e-12);
}

TEST(RankSum, WhatIsEqualDiffersByChanceOnly) {
  EXPECT_EQ(RankSumProbability({5, 5, 5}, {5, 5, 5}), 1);
  EXPECT_EQ(RankSumProbability({}, {1}), 1);
  EXPECT_EQ(RankSumProbability(std::vector<double>(100, 3), std::vector<double>(100, 3)), 1);
}

TEST(RankSum, DoesNotCareForTheOrderOfTheSamples) {
  const std::vector<double> a{3, 1, 7, 7, 2}, b{4, 7, 9, 5};
  EXPECT_DOUBLE_EQ(RankSumProbability(a, b), RankSumProbability(b, a));
}

TEST(RankSum, ManyValuesFollowTheNormalDistribution) {
  std::mt19937_64 engine(7);
  std::vector<double> a(30), b(30), longer_a, longer_b;
  for (double& value : a) value = static_cast<double>(engine() % 1000);
  for (double& value : b) value = static_cast<double>(engine() % 1000) + 150;
  const double exact = RankSumProbability(a, b);
  longer_a = a;
  longer_b = b;
  longer_a.push_back(500);  // 61: no longer exact
  EXPECT_NEAR(RankSumProbability(longer_a, longer_b), exact, 0.3 * exact + 0.01);
}

// Of equal samples a share of 5 % has a probability below 5 %, no more.
TEST(RankSum, FindsNothingInEqualSamplesButAsOftenAsItSays) {
  std::mt19937_64 engine(11);
  int found = 0;
  for (int i = 0; i < 400; ++i) {
    std::vector<double> a(12), b(12);
    for (double& value : a) value = static_cast<double>(engine() >> 11);
    for (double& value : b) value = static_cast<double>(engine() >> 11);
    found += RankSumProbability(a, b) < 0.05 ? 1 : 0;
  }
  EXPECT_GT(found, 5);
  EXPECT_LT(found, 36);  // 20 expected, with a deviation of 4.4
}

TEST(RankSum, TheLeastIsThatOfSamplesApart) {
  EXPECT_NEAR(LeastRankSumProbability(5, 5), 2.0 / 252, 1e-12);
  EXPECT_NEAR(LeastRankSumProbability(3, 3), 0.1, 1e-12);
  EXPECT_EQ(LeastRankSumProbability(0, 5), 1);
  EXPECT_EQ(LeastRankSumProbability(1, 1), 1);
}

}  // namespace
}  // namespace tcs::compare
