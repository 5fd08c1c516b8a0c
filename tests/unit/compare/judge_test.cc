#include "coordinator/compare/judge.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace tcs::compare {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr Measure kTime{0, MeasureUnit::kSeconds, WorseWhen::kMore, true};
constexpr Measure kMisses{0, MeasureUnit::kShare, WorseWhen::kMore, true};
constexpr Measure kOwn{0, MeasureUnit::kNumber, WorseWhen::kUnknown, true};

// Response times of a planner as they were recorded in 30 measured trials of one second, in ms.
constexpr double kRecorded[] = {44.1, 43.2, 45.9, 43.7, 44.4, 43.1, 43.0, 47.2, 43.6, 44.0,
                                43.9, 43.3, 43.5, 46.1, 43.4, 44.9, 43.8, 43.2, 45.2, 43.7,
                                43.1, 44.6, 43.0, 43.9, 52.3, 43.5, 43.6, 44.2, 43.3, 43.4};

Sample Take(const Measure& kind, const std::vector<double>& values, std::uint64_t first_seed = 1) {
  Sample sample{kind, values, {}};
  for (std::size_t i = 0; i < values.size(); ++i) sample.seeds.push_back(first_seed + i);
  return sample;
}

Side Trials(const std::string& folder) {
  Side side;
  side.folder = folder;
  side.scenario = "s";
  side.accounting = "measured";
  side.sync = "consistent";
  side.cells[""].trials = 30;
  return side;
}

// Thirty trials drawn from those recorded, each value times `factor`.
std::vector<double> Drawn(std::uint64_t seed, double factor, std::size_t count = 30) {
  std::mt19937_64 engine(seed);
  std::vector<double> values(count);
  for (double& value : values) {
    value = 1e-3 * factor * (kRecorded[engine() % 30] + 1e-3 * static_cast<double>(engine() % 100));
  }
  return values;
}

const Finding& Of(const Comparison& comparison, const std::string& figure) {
  const auto found = std::find_if(comparison.findings.begin(), comparison.findings.end(),
                                  [&](const Finding& one) { return one.figure == figure; });
  EXPECT_NE(found, comparison.findings.end()) << figure;
  return *found;
}

class JudgeTest : public ::testing::Test {
 protected:
  void Both(const std::string& figure, const Measure& kind, const std::vector<double>& a,
            const std::vector<double>& b) {
    a_.cells[""].samples[figure] = Take(kind, a);
    b_.cells[""].samples[figure] = Take(kind, b, 101);
  }
  Comparison Compare() { return Judge(a_, b_, options_); }

  Side a_ = Trials("a"), b_ = Trials("b");
  JudgeOptions options_;
};

TEST_F(JudgeTest, FindsAPlannerThatBecameAFifthSlowerAmongManyFigures) {
  Both("r/planner.response_p50", kTime, Drawn(1, 1), Drawn(2, 1.2));
  for (int i = 0; i < 60; ++i) {
    const auto n = static_cast<std::uint64_t>(i);
    Both(fmt::format("r/other{}.response_p50", i), kTime, Drawn(100 + n, 1), Drawn(200 + n, 1));
  }
  const Comparison comparison = Compare();
  EXPECT_TRUE(comparison.IsWorse());
  ASSERT_EQ(comparison.Count(Outcome::kWorse), 1u);
  const Finding& found = comparison.findings.front();
  EXPECT_EQ(found.figure, "r/planner.response_p50");
  EXPECT_NEAR(*found.Relative(), 0.2, 0.02);
  EXPECT_GT(found.difference.low, 0.1 * 0.0435);
  EXPECT_LT(*found.probability, 1e-6);
}

TEST_F(JudgeTest, FindsNothingInTheSameTwice) {
  for (std::uint64_t round = 0; round < 10; ++round) {
    for (int i = 0; i < 20; ++i) {
      const auto n = round * 1000 + static_cast<std::uint64_t>(i);
      Both(fmt::format("r/c{}.response_p50", i), kTime, Drawn(n, 1), Drawn(n + 500, 1));
    }
    EXPECT_FALSE(Compare().IsWorse()) << round;
  }
}

TEST_F(JudgeTest, WhatBecameBetterIsNotWorse) {
  Both("r/p.response_p50", kTime, Drawn(1, 1.2), Drawn(2, 1));
  const Comparison comparison = Compare();
  EXPECT_EQ(comparison.Count(Outcome::kBetter), 1u);
  EXPECT_FALSE(comparison.IsWorse());
}

TEST_F(JudgeTest, ASmallDifferenceIsWithinTheTolerance) {
  Both("r/p.response_p50", kTime, Drawn(1, 1, 300), Drawn(2, 1.03, 300));
  EXPECT_EQ(Compare().Count(Outcome::kSmall), 1u);
  options_.tolerance = 0.01;
  EXPECT_EQ(Compare().Count(Outcome::kWorse), 1u);
}

TEST_F(JudgeTest, MissesFromNothingAreBeyondAnyTolerance) {
  std::vector<double> some(30, 0.0);
  for (std::size_t i = 0; i < 12; ++i) some[i] = 0.01;
  Both("r/p.missed", kMisses, std::vector<double>(30, 0.0), some);
  const Comparison comparison = Compare();
  ASSERT_EQ(comparison.Count(Outcome::kWorse), 1u);
  EXPECT_FALSE(comparison.findings.front().Relative().has_value());
  EXPECT_NEAR(comparison.findings.front().difference.size, 0.004, 1e-9);
}

TEST_F(JudgeTest, OwnFiguresHaveTheDirectionThatTheyAreGiven) {
  Both("score.last", kOwn, Drawn(1, 1), Drawn(2, 0.8));
  EXPECT_EQ(Compare().Count(Outcome::kChanged), 1u);
  EXPECT_TRUE(Compare().IsWorse());
  options_.more_is_better = {"score"};
  EXPECT_EQ(Compare().Count(Outcome::kWorse), 1u);
  options_.more_is_better.clear();
  options_.less_is_better = {"score.last"};
  EXPECT_EQ(Compare().Count(Outcome::kBetter), 1u);
}

TEST_F(JudgeTest, TooFewTrialsAreSaidToBeTooFew) {
  Both("r/p.response_p50", kTime, {1, 1.1, 1.2}, {9, 9.1, 9.2});
  Both("r/q.response_p50", kTime, {1, 1.1, 1.2}, {1, 1.2, 1.1});
  const Comparison comparison = Compare();
  EXPECT_FALSE(comparison.IsWorse());
  EXPECT_THAT(comparison.warnings,
              Contains(HasSubstr("3 trials are too few to tell any difference of 2 figures")));
  EXPECT_THAT(comparison.warnings, Contains(HasSubstr("make at least 6 of each")));
}

TEST_F(JudgeTest, InFixedModeTheSameSeedsNeedNoChance) {
  a_.accounting = b_.accounting = "fixed";
  Both("r/p.response_p50", kTime, {1, 2, 3}, {1.2, 2.4, 3.6});
  b_.cells[""].samples["r/p.response_p50"] = Take(kTime, {1.2, 2.4, 3.6});
  const Comparison comparison = Compare();
  ASSERT_EQ(comparison.Count(Outcome::kWorse), 1u);
  EXPECT_EQ(comparison.findings.front().evidence, Evidence::kFixed);
  EXPECT_DOUBLE_EQ(comparison.findings.front().difference.size, 2.4 - 2);
  // Of other seeds nobody knows that.
  b_.cells[""].samples["r/p.response_p50"] = Take(kTime, {1.2, 2.4, 3.6}, 7);
  EXPECT_EQ(Compare().findings.front().evidence, Evidence::kTrials);
}

TEST_F(JudgeTest, OneRunOfEachIsJudgedByItsPartsOrNotAtAll) {
  a_.is_run = b_.is_run = true;
  a_.cells[""].trials = b_.cells[""].trials = 1;
  Both("r/p.response_p50", kTime, {0.0435}, {0.052});
  Both("r/p.response_max", kTime, {0.05}, {0.09});
  a_.cells[""].parts["r/p.response_p50"] = Drawn(1, 1, 20);
  b_.cells[""].parts["r/p.response_p50"] = Drawn(2, 1.2, 20);
  const Comparison comparison = Compare();
  EXPECT_EQ(Of(comparison, "r/p.response_p50").outcome, Outcome::kWorse);
  EXPECT_EQ(Of(comparison, "r/p.response_max").outcome, Outcome::kUnjudged);
  EXPECT_THAT(comparison.warnings,
              Contains(HasSubstr("from one run of each nobody can tell how much runs differ")));
}

TEST_F(JudgeTest, ARunThatFailedIsAFact) {
  a_.is_run = b_.is_run = true;
  a_.cells[""].trials = 1;
  b_.cells[""].trials = 0;
  b_.cells[""].failed = 1;
  Both("run.failed", kMisses, {0}, {1});
  EXPECT_EQ(Compare().Count(Outcome::kWorse), 1u);
}

TEST_F(JudgeTest, AGridIsComparedCellByCell) {
  a_.keys = b_.keys = {"speed"};
  a_.cells.clear();
  b_.cells.clear();
  for (const char* value : {"speed=1", "speed=2", "speed=4"}) {
    const double factor = std::string(value) == "speed=2" ? 1.2 : 1;
    a_.cells[value].trials = b_.cells[value].trials = 30;
    a_.cells[value].samples["r/p.response_p50"] = Take(kTime, Drawn(1, 1));
    b_.cells[value].samples["r/p.response_p50"] = Take(kTime, Drawn(2, factor), 101);
  }
  b_.cells["speed=8"] = b_.cells["speed=4"];
  const Comparison comparison = Compare();
  ASSERT_EQ(comparison.Count(Outcome::kWorse), 1u);
  EXPECT_EQ(comparison.findings.front().cell, "speed=2");
  EXPECT_EQ(comparison.findings.size(), 3u);
  EXPECT_THAT(comparison.warnings, Contains(HasSubstr("only b has trials with speed=8")));
}

TEST_F(JudgeTest, WhatCannotBeComparedIsSaid) {
  Both("r/p.response_p50", kTime, {1}, {1});
  EXPECT_EQ(WhyNotComparable(a_, b_, options_), "");
  a_.is_run = true;
  EXPECT_THAT(WhyNotComparable(a_, b_, options_), HasSubstr("a is one run, and b are trials"));
  a_.is_run = false;
  a_.keys = {"speed"};
  EXPECT_THAT(WhyNotComparable(a_, b_, options_),
              HasSubstr("a varies speed, and b varies nothing"));
  b_.keys = {"speed"};
  b_.cells["speed=2"] = b_.cells[""];
  b_.cells.erase("");
  EXPECT_THAT(WhyNotComparable(a_, b_, options_), HasSubstr("no values of speed in common"));
}

TEST_F(JudgeTest, AFigureThatNobodyHasIsNamed) {
  Both("r/p.response_p50", kTime, {1}, {1});
  options_.measures = {"p.response_p55"};
  EXPECT_THAT(WhyNotComparable(a_, b_, options_), HasSubstr("did you mean 'r/p.response_p50'?"));
  options_.measures = {"p"};
  EXPECT_EQ(WhyNotComparable(a_, b_, options_), "");
}

TEST_F(JudgeTest, OnlyWhatIsWantedIsCompared) {
  Both("r/p.response_p50", kTime, {1}, {1});
  Both("r/q.response_p50", kTime, {1}, {1});
  options_.measures = {"q"};
  ASSERT_EQ(Compare().findings.size(), 1u);
  EXPECT_EQ(Compare().findings.front().figure, "r/q.response_p50");
}

// A client that starves has no response times: that is no all-clear.
TEST_F(JudgeTest, AFigureThatIsGoneIsWorse) {
  Both("r/p.response_p50", kTime, Drawn(1, 1), Drawn(2, 1));
  a_.cells[""].samples["r/c.response_p50"] = Take(kTime, Drawn(3, 1));
  const Comparison comparison = Compare();
  EXPECT_THAT(comparison.gone, ::testing::ElementsAre("r/c.response_p50"));
  EXPECT_TRUE(comparison.IsWorse());
}

TEST_F(JudgeTest, AFigureThatFewerTrialsHaveIsWarnedOf) {
  Both("r/p.response_p50", kTime, Drawn(1, 1), Drawn(2, 1, 20));
  Both("r/q.response_p50", kTime, Drawn(3, 1), Drawn(4, 1));
  const Comparison comparison = Compare();
  EXPECT_FALSE(comparison.is_blind);
  EXPECT_THAT(comparison.warnings,
              Contains(HasSubstr("fewer trials of b than of a have r/p.response_p50")));
}

TEST_F(JudgeTest, UnlikeSidesAreWarnedOf) {
  Both("r/p.response_p50", kTime, {1}, {1});
  b_.scenario = "other";
  b_.sync = "callback";
  b_.cells[""].samples["new.last"] = Take(kOwn, {1});
  const Comparison comparison = Compare();
  EXPECT_THAT(comparison.warnings,
              Contains(HasSubstr("a is of the scenario 's', and b of 'other'")));
  EXPECT_THAT(comparison.warnings, Contains(HasSubstr("--sync consistent, and b with callback")));
  EXPECT_THAT(comparison.warnings, Contains(HasSubstr("only b has new.last")));
}

}  // namespace
}  // namespace tcs::compare
