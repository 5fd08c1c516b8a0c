#include "coordinator/answers/distribution.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

TEST(Distribution, OfNothingIsNothing) {
  const Distribution none;
  EXPECT_EQ(none.count(), 0);
  EXPECT_EQ(none.max(), 0);
  EXPECT_EQ(none.Mean(), 0);
  EXPECT_EQ(none.Quantile(0.5), 0);
}

TEST(Distribution, HasTheNearestRank) {
  Distribution of;
  for (int value = 100; value >= 1; --value) of.Add(value);
  EXPECT_EQ(of.Quantile(0.5), 50);
  EXPECT_EQ(of.Quantile(0.99), 99);
  EXPECT_EQ(of.Quantile(1), 100);
  EXPECT_EQ(of.Quantile(0), 1);
  EXPECT_EQ(of.max(), 100);
  EXPECT_DOUBLE_EQ(of.Mean(), 50.5);
}

TEST(Distribution, LessThanNothingIsNothing) {
  Distribution of;
  of.Add(-5);
  EXPECT_EQ(of.count(), 1);
  EXPECT_EQ(of.max(), 0);
  EXPECT_EQ(of.Quantile(0.5), 0);
}

// A million different values: in a bounded space, within 0.1 %, and the greatest exactly.
TEST(Distribution, ManyValuesAreRounded) {
  constexpr std::int64_t kCount = 1'000'000, kStep = 1'009;
  Distribution of;
  for (std::int64_t i = 1; i <= kCount; ++i) of.Add(i * kStep);
  EXPECT_EQ(of.count(), kCount);
  EXPECT_EQ(of.max(), kCount * kStep);
  for (const double share : {0.01, 0.5, 0.99}) {
    const double exact = share * static_cast<double>(kCount * kStep);
    const auto found = static_cast<double>(of.Quantile(share));
    EXPECT_LE(found, exact);
    EXPECT_GT(found, 0.999 * exact);
  }
}

TEST(Distribution, OfTwoIsOfAllTheirValues) {
  Distribution of, odd;
  for (int value = 2; value <= 100; value += 2) of.Add(value);
  for (int value = 1; value < 100; value += 2) odd.Add(value);
  of.Add(odd);
  of.Add(Distribution());
  EXPECT_EQ(of.count(), 100);
  EXPECT_EQ(of.min(), 1);
  EXPECT_EQ(of.max(), 100);
  EXPECT_EQ(of.Quantile(0.37), 37);
  EXPECT_DOUBLE_EQ(of.Mean(), 50.5);
}

}  // namespace
}  // namespace tcs
