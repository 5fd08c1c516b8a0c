#include "coordinator/report/statistics.h"

#include <gtest/gtest.h>

namespace tcs::report {
namespace {

// The values of R: x <- c(2, 4, 4, 4, 5, 5, 7, 9); mean(x); sd(x); quantile(x).
TEST(Statistics, ASpreadIsWhatOtherProgramsSay) {
  const Spread spread = SpreadOf({9, 4, 5, 2, 4, 7, 5, 4});
  EXPECT_EQ(spread.count, 8);
  EXPECT_DOUBLE_EQ(spread.mean, 5.0);
  EXPECT_NEAR(spread.deviation, 2.13809, 1e-5);
  EXPECT_DOUBLE_EQ(spread.least, 2.0);
  EXPECT_DOUBLE_EQ(spread.lower_quartile, 4.0);
  EXPECT_DOUBLE_EQ(spread.median, 4.5);
  EXPECT_DOUBLE_EQ(spread.upper_quartile, 5.5);
  EXPECT_DOUBLE_EQ(spread.most, 9.0);
}

TEST(Statistics, NothingHasASpreadOfZeros) {
  const Spread spread = SpreadOf({});
  EXPECT_EQ(spread.count, 0);
  EXPECT_EQ(spread.mean, 0.0);
  EXPECT_EQ(ShareBelow({}, 5.0), 0.0);
}

TEST(Statistics, OneValueIsItsOwnMedianAndDeviatesFromNothing) {
  const Spread spread = SpreadOf({3.5});
  EXPECT_EQ(spread.median, 3.5);
  EXPECT_EQ(spread.upper_quartile, 3.5);
  EXPECT_EQ(spread.deviation, 0.0);
}

TEST(Statistics, BetweenTwoValuesAQuantileIsInterpolated) {
  EXPECT_DOUBLE_EQ(Quantile({10, 20}, 0.25), 12.5);
  EXPECT_DOUBLE_EQ(Quantile({10, 20}, 1.0), 20.0);
}

TEST(Statistics, WhatIsAtTheLimitIsNotBelowIt) {
  EXPECT_DOUBLE_EQ(ShareBelow({4, 5, 6, 4.999}, 5), 0.5);
}

TEST(Histogram, ALowerEdgeBelongsToItsBin) {
  const Histogram histogram = HistogramOf({0, 0.5, 1, 1.5, 2}, 0, 3, 1);
  EXPECT_EQ(histogram.counts, (std::vector<std::int64_t>{2, 2, 1}));
  EXPECT_DOUBLE_EQ(histogram.ShareOf(0), 0.4);
}

TEST(Histogram, WhatLiesOutsideCountsAtTheEnds) {
  const Histogram histogram = HistogramOf({-1, 3, 7}, 0, 3, 1);
  EXPECT_EQ(histogram.counts, (std::vector<std::int64_t>{1, 0, 2}));
  EXPECT_EQ(histogram.total, 3);
}

TEST(Histogram, RoundingMakesNoFurtherBin) {
  EXPECT_EQ(HistogramOf({}, 0, 0.3, 0.1).counts.size(), 3u);
  EXPECT_EQ(HistogramOf({}, 0, 0, 0.1).counts.size(), 1u);
}

}  // namespace
}  // namespace tcs::report
