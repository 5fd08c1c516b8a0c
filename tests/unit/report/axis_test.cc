#include "coordinator/report/axis.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "coordinator/report/sweep_figure.h"

namespace tcs::report {
namespace {

std::vector<std::string> Labels(const Axis& axis) {
  std::vector<std::string> labels;
  for (const double tick : axis.ticks()) labels.push_back(axis.Label(tick));
  return labels;
}

TEST(Axis, TicksAreRoundNumbers) {
  const Axis axis = Axis::Linear(0, 19.3, 5);
  EXPECT_EQ(axis.high(), 20);
  EXPECT_EQ(Labels(axis), (std::vector<std::string>{"0", "5", "10", "15", "20"}));
  EXPECT_EQ(Labels(Axis::Linear(0, 0.9, 2)), (std::vector<std::string>{"0.0", "0.5", "1.0"}));
}

TEST(Axis, AnExactOneEndsWhereItsValuesDo) {
  const Axis axis = Axis::Exact(0, 1.7, 4);
  EXPECT_EQ(axis.high(), 1.7);
  EXPECT_EQ(Labels(axis), (std::vector<std::string>{"0.0", "0.5", "1.0", "1.5"}));
}

TEST(Axis, OneValueStillHasAScale) {
  Axis axis = Axis::Linear(0, 0, 5);
  axis.Place(100, 0);
  EXPECT_EQ(axis.Pixel(0), 100);
  EXPECT_GT(axis.high(), 0);
  EXPECT_GT(Axis::Decades(3, 3).high(), Axis::Decades(3, 3).low());
}

TEST(Axis, FactorsAreDistancesOnALogarithmicOne) {
  Axis axis = Axis::Logarithmic(0.25, 8);
  axis.Place(0, 100);
  EXPECT_EQ(axis.low(), 0.2);
  EXPECT_EQ(axis.high(), 10);
  EXPECT_NEAR(axis.Pixel(2) - axis.Pixel(1), axis.Pixel(8) - axis.Pixel(4), 1e-9);
  EXPECT_EQ(Labels(axis), (std::vector<std::string>{"0.2", "0.5", "1", "2", "5", "10"}));
}

TEST(Axis, ManyDecadesHaveATickEach) {
  EXPECT_EQ(Labels(Axis::Decades(0.3, 4000)),
            (std::vector<std::string>{"0.1", "1", "10", "100", "1000", "10\u202f000"}));
}

TEST(Sweeps, ValuesThatGrowByFactorsWantALogarithmicAxis) {
  EXPECT_TRUE(IsGeometric({0.25, 0.5, 1, 2, 4, 8}));
  EXPECT_TRUE(IsGeometric({20, 60, 180}));
  EXPECT_FALSE(IsGeometric({1, 2, 3, 4, 5}));
  EXPECT_FALSE(IsGeometric({1, 8}));
  EXPECT_FALSE(IsGeometric({0, 1, 10, 100}));
}

}  // namespace
}  // namespace tcs::report
