// When effort ratios cross -1 or 1, of known functions of the time.
#include "simbody_bridge/joints/limit_crossings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace tcs {
namespace {

using Ratio = std::function<double(double)>;

constexpr double kLong = 1e-2;

struct Found {
  double at_s = 0;
  int looks = 0;
};

Found PredictOf(const std::vector<Ratio>& ratios, double h, LimitCrossings* crossings) {
  Found found;
  const auto at = [&](double seconds, std::vector<double>* values) {
    values->clear();
    for (const Ratio& of : ratios) values->push_back(of(seconds));
    ++found.looks;
  };
  std::vector<double> start;
  at(0, &start);
  found.looks = 0;
  crossings->Begin(start);
  found.at_s = crossings->Predict(h, at);
  return found;
}

Found PredictOf(const std::vector<Ratio>& ratios, double h = kLong) {
  LimitCrossings crossings;
  return PredictOf(ratios, h, &crossings);
}

struct Course {
  const char* name;
  std::function<Ratio(double)> crossing_at;
};

// Those that a servo's effort takes: pushed at first, on its way to a speed, as its lag has it.
const std::vector<Course>& Courses() {
  static const std::vector<Course> kCourses = {
      {"a line", [](double at) -> Ratio { return [=](double t) { return t / at; }; }},
      {"a line down",
       [](double at) -> Ratio { return [=](double t) { return 0.5 - 1.5 * t / at; }; }},
      {"a square",
       [](double at) -> Ratio { return [=](double t) { return -0.9 + 1.9 * t / at * t / at; }; }},
      {"a decay from beyond",
       [](double at) -> Ratio {
         return [=](double t) { return 0.5 + 2.5 * std::exp(-t / at * std::log(5)); };
       }},
      {"an approach", [](double at) -> Ratio {
         return [=](double t) { return 3 * (1 - std::exp(t / at * std::log(2.0 / 3))); };
       }}};
  return kCourses;
}

TEST(LimitCrossings, AreFoundFromAnyDistanceAndHaveJustHappened) {
  for (const Course& course : Courses()) {
    for (const double at_s : {2e-8, 1e-6, 1e-4, 3e-3, 9e-3}) {
      const Ratio ratio = course.crossing_at(at_s);
      const Found found = PredictOf({ratio});
      // A servo's ratio is past its limit by less than 1e-4, or it is the next nanosecond.
      EXPECT_GE(found.at_s, at_s - 1e-12) << course.name;
      const double past = std::abs(std::abs(ratio(found.at_s)) - 1);
      EXPECT_TRUE(past < 1e-4 || found.at_s < at_s + 2.1e-9) << course.name << at_s << ' ' << past;
      EXPECT_LE(found.looks, 24) << course.name << at_s;
    }
  }
}

TEST(LimitCrossings, OfSeveralJointsAreTheFirstOnes) {
  const Ratio early = [](double t) { return -t / 2e-4; }, late = [](double t) { return t / 3e-4; };
  const Ratio never = [](double t) { return 0.9 * std::cos(1e3 * t); };
  for (const std::vector<Ratio>& ratios :
       {std::vector{early, late, never}, std::vector{never, late, early}}) {
    EXPECT_NEAR(PredictOf(ratios).at_s, 2e-4, 1e-8);
  }
}

TEST(LimitCrossings, AreNoneWhereNothingCrosses) {
  const double infinite = std::numeric_limits<double>::infinity(), nan = std::nan("");
  for (const double constant : {0.0, 0.99, -3.0, infinite, nan}) {
    const Found found = PredictOf({[=](double) { return constant; }});
    EXPECT_EQ(found.at_s, kLong);
    EXPECT_EQ(found.looks, 1);
  }
  EXPECT_EQ(PredictOf({[&](double t) { return t > 0 ? nan : 0; }}).at_s, kLong);
  EXPECT_EQ(PredictOf({}).at_s, kLong);
}

// The motion itself is a little slower than the one that was predicted.
TEST(LimitCrossings, ThatComeLateAreFoundByTheirSlope) {
  LimitCrossings crossings;
  const Found found = PredictOf({[](double t) { return 3 - 2.2 * t / 1e-4; }}, kLong, &crossings);
  const Ratio motion = [](double t) { return 3 - 2 * t / 1e-4; };
  EXPECT_NEAR(crossings.Late(found.at_s, {motion(found.at_s)}), 1e-4, 1e-6);
  const double behind_s = 1.2e-4;
  EXPECT_EQ(crossings.Late(behind_s, {motion(behind_s)}), behind_s);
}

TEST(LimitCrossings, OfFailedTriesAreFoundByTheirOwnSlope) {
  const Ratio motion = [](double t) { return 0.5 + 2.5 * std::exp(-t / 1e-4 * std::log(5)); };
  LimitCrossings crossings;
  PredictOf({[](double) { return 3.0; }}, kLong, &crossings);
  double h = 1.1e-4;
  for (int tries = 0; tries < 8; ++tries) {
    const double next = crossings.First(h, {motion(h)});
    if (next == h) break;
    ASSERT_LT(next, h);
    h = next;
  }
  EXPECT_NEAR(h, 1e-4, 1e-6);
}

}  // namespace
}  // namespace tcs
