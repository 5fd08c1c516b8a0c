#include "coordinator/compare/words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace tcs::compare {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Side Named(const std::string& folder) {
  Side side;
  side.folder = folder;
  side.cells[""].trials = 30;
  return side;
}

Comparison OneWorse() {
  Finding worse{"",
                "r/planner.response_p50",
                MeasureUnit::kSeconds,
                0.040,
                0.048,
                {0.008, 0.0075, 0.0085},
                Evidence::kTrials,
                2e-9,
                Outcome::kWorse};
  Finding same{"",  "r/planner.missed", MeasureUnit::kShare, 0, 0, {0, 0, 0}, Evidence::kTrials,
               1.0, Outcome::kChance};
  return {{worse, same}, {}};
}

TEST(CompareWords, SayWhatBecameWorseByHowMuchAndWhetherByChance) {
  const std::string text = CompareText(Named("a"), Named("b"), OneWorse(), {});
  EXPECT_THAT(text, HasSubstr("! worse: r/planner.response_p50 is 48.0\u00a0ms, was 40.0\u00a0ms: "
                              "+20 % (+7.50\u00a0ms to +8.50\u00a0ms); chance makes that less than "
                              "once in 10\u202f000 such comparisons\n"));
  EXPECT_THAT(text, HasSubstr("2 figures compared: 1 worse, 0 changed"));
  EXPECT_THAT(text, Not(HasSubstr("r/planner.missed")));
}

TEST(CompareWords, SayThatNothingDid) {
  Comparison none = OneWorse();
  none.findings.erase(none.findings.begin());
  EXPECT_THAT(CompareText(Named("a"), Named("b"), none, {}),
              HasSubstr("nothing became worse in B"));
}

TEST(CompareWords, GiveNoAllClearWhereNobodyCanTell) {
  Comparison none = OneWorse();
  none.findings.erase(none.findings.begin());
  none.is_blind = true;
  EXPECT_THAT(CompareText(Named("a"), Named("b"), none, {}),
              HasSubstr("nothing can be told from chance: there are too few trials"));
  none.gone = {"r/c.missed"};
  const std::string text = CompareText(Named("a"), Named("b"), none, {});
  EXPECT_THAT(text, HasSubstr("! gone: B has no r/c.missed"));
  EXPECT_THAT(text, Not(HasSubstr("nothing")));
}

TEST(CompareWords, ForProgramsAreAllFigures) {
  const auto json = nlohmann::json::parse(CompareJson(Named("a"), Named("b"), OneWorse(), {}));
  EXPECT_EQ(json["worse"], true);
  ASSERT_EQ(json["figures"].size(), 2u);
  EXPECT_EQ(json["figures"][0]["outcome"], "worse");
  EXPECT_NEAR(json["figures"][0]["relative"].get<double>(), 0.2, 1e-9);
  EXPECT_EQ(json["figures"][1]["relative"], nullptr);
  EXPECT_EQ(json["a"]["folder"], "a");
}

}  // namespace
}  // namespace tcs::compare
