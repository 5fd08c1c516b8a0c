// What the values of a metric come to, and under which names.
#include "coordinator/metrics/metric_sums.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "coordinator/metrics/metric_book.h"

namespace tcs {
namespace {

using testing::ElementsAre;
using testing::Key;

TEST(MetricSumsTest, KnowsFiguresOfItsValues) {
  MetricSums sums;
  EXPECT_EQ(sums.figures().count, 0);
  EXPECT_EQ(sums.figures().first_time_ns, -1);
  sums.Add(5, 3, false);
  sums.Add(7, -4);
  sums.Add(9, 1);
  const MetricFigures& f = sums.figures();
  EXPECT_EQ(f.count, 3);
  EXPECT_EQ(f.last, 1);
  EXPECT_EQ(f.min, -4);
  EXPECT_EQ(f.max, 3);
  EXPECT_NEAR(f.mean, 0, 1e-15);
  EXPECT_NEAR(f.rms, std::sqrt(26.0 / 3), 1e-14);
  EXPECT_EQ(f.first_time_ns, 7);
}

TEST(MetricSumsTest, KeepsItsPrecisionOverManyValues) {
  MetricSums sums;
  for (int i = 0; i < 1'000'000; ++i) sums.Add(i, 1e6 + (i % 2 == 0 ? 1e-3 : -1e-3));
  EXPECT_NEAR(sums.figures().mean, 1e6, 1e-9);
}

TEST(MetricBookTest, NamesMetricsOfSeveralSourcesApart) {
  MetricBook book;
  const auto add = [&](std::string_view from, std::string_view name, double value) {
    book.Add(book.NumberOf(from, name), 1, value);
  };
  add("r/a", "own", 1);
  add("r/a", "shared", 2);
  add("r/b", "shared", 3);
  add("r/b", "height", 4);
  add(kMetricFromScenario, "height", 5);
  add("r/a", "own", 6);
  const MetricsOfRun figures = book.Figures();
  EXPECT_THAT(figures, ElementsAre(Key("height"), Key("own"), Key("r/a/shared"), Key("r/b/height"),
                                   Key("r/b/shared")));
  EXPECT_EQ(figures.at("own").count, 2);
  EXPECT_EQ(figures.at("own").from, "r/a");
  EXPECT_EQ(figures.at("height").last, 5);
  EXPECT_EQ(figures.at("r/b/shared").last, 3);
}

TEST(MetricBookTest, TakesNoMoreThanSoManyOfOneSource) {
  MetricBook book;
  for (std::size_t i = 0; i < MetricBook::kMostOfOneSource; ++i) {
    EXPECT_GE(book.NumberOf("r/a", std::to_string(i)), 0);
  }
  EXPECT_EQ(book.NumberOf("r/a", "one more"), -1);
  EXPECT_GE(book.NumberOf("r/a", "7"), 0);
  EXPECT_GE(book.NumberOf("r/b", "one more"), 0);
}

}  // namespace
}  // namespace tcs
