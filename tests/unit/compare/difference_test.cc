#include "coordinator/compare/difference.h"

#include <gtest/gtest.h>

#include <random>

namespace tcs::compare {
namespace {

TEST(Difference, AShiftIsFoundWhateverTheExtremes) {
  std::vector<double> a, b;
  for (int i = 0; i < 30; ++i) {
    a.push_back(i);
    b.push_back(i + 10);
  }
  b.back() = 1e9;
  const Difference shift = ShiftBetween(a, b);
  EXPECT_NEAR(shift.size, 10, 1);
  EXPECT_LT(shift.low, 10);
  EXPECT_GT(shift.high, 10);
  EXPECT_LT(shift.high - shift.low, 15);
}

// R: wilcox.test(y, x, conf.int = TRUE) of its own example: 0.305 (-0.15 to 0.76), from exact
// ranks.
TEST(Difference, IsThatOfOthers) {
  const std::vector<double> x{0.80, 0.83, 1.89, 1.04, 1.45, 1.38, 1.91, 1.64, 0.73, 1.46};
  const std::vector<double> y{1.15, 0.88, 0.90, 0.74, 1.21};
  const Difference shift = ShiftBetween(y, x);
  EXPECT_NEAR(shift.size, 0.305, 1e-9);
  EXPECT_NEAR(shift.low, -0.15, 0.04);
  EXPECT_NEAR(shift.high, 0.76, 0.04);
}

TEST(Difference, FewValuesHaveAWideInterval) {
  const Difference shift = ShiftBetween({1}, {4});
  EXPECT_EQ(shift.size, 3);
  EXPECT_EQ(shift.low, 3);
  EXPECT_EQ(shift.high, 3);
}

TEST(Difference, OfThousandsIsTheSame) {
  std::mt19937_64 engine(3);
  std::vector<double> a(5000), b(5000);
  for (double& value : a) value = static_cast<double>(engine() % 1000);
  for (double& value : b) value = static_cast<double>(engine() % 1000) + 100;
  EXPECT_NEAR(ShiftBetween(a, b).size, 100, 20);
}

TEST(Difference, OfMeansSeesWhatMostTrialsDoNotHave) {
  std::vector<double> a(30, 0.0), b(30, 0.0);
  for (int i = 0; i < 6; ++i) b[static_cast<std::size_t>(i)] = 100;
  const Difference means = MeanDifference(a, b);
  EXPECT_EQ(means.size, 20);
  EXPECT_GT(means.low, 3);
  EXPECT_LT(means.high, 45);
  EXPECT_EQ(MeanDifference(a, b).low, means.low);  // whenever it is asked
  EXPECT_EQ(ShiftBetween(a, b).size, 0);
}

}  // namespace
}  // namespace tcs::compare
