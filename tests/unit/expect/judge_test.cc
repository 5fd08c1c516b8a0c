// Whether a run came to what is expected, from the text of its summary.
#include "coordinator/expect/judge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/expect/expect_json.h"

namespace tcs {
namespace {

using testing::HasSubstr;

constexpr const char* kSummary = R"({
  "clients": {
    "r/late": {"activations": 9, "response_ns": {"count": 9, "p50": 1000000, "p99": 5000001, "max": 6000000},
               "deadline": {"deadline_ns": 5000000, "judged": 9, "missed": 2, "most_in_a_row": 1,
                            "first_missed_ns": 310000000}},
    "r/idle": {"activations": 0, "response_ns": {"count": 0},
               "deadline": {"deadline_ns": 5000000, "judged": 0, "missed": 0, "most_in_a_row": 0,
                            "first_missed_ns": -1}},
    "r/free": {"activations": 3, "deadline": null}
  },
  "chains": {"eye->hand": {"deadline_ns": 80000000, "missed": 1, "first_missed_ns": 2500000000,
                           "age_ns": {"count": 4, "p50": 1, "p99": 62000000, "max": 3}}},
  "metrics": {"error": {"from": "scenario", "asked": "rms", "count": 3, "rms": 0.2, "first_time_ns": 0},
              "plan": {"from": "r/late", "count": 2, "max": 1.5, "first_time_ns": 7}}
})";

ExpectationSpec Of(const std::string& subject, const std::string& of, const std::string& figure,
                   double most, MeasureUnit unit = MeasureUnit::kCount) {
  ExpectationSpec expected;
  expected.subject = subject;
  expected.figure = figure;
  expected.measure = of + "." + figure;
  expected.unit = unit;
  expected.most = most;
  return expected;
}

Judgement Judged(const ExpectationSpec& expected, const MetricsOfRun& kept = {}) {
  return JudgeRun({expected}, kSummary, kept).at(0);
}

TEST(JudgeRun, SaysWhatItWasAndWhenFirst) {
  const Judgement misses = Judged(Of("r/late", "r/late", "misses", 1));
  EXPECT_FALSE(misses.holds);
  EXPECT_EQ(misses.what, "misses was 2, expected at most 1, first at 0.310 s");
  EXPECT_TRUE(Judged(Of("r/late", "r/late", "misses", 2)).holds);
  const Judgement chain = Judged(Of("chain eye->hand", "chain eye->hand", "misses", 0));
  EXPECT_EQ(chain.what, "misses was 1, expected at most 0, first at 2.500 s");
}

TEST(JudgeRun, HoldsAtTheBoundAndNotBehind) {
  auto response = Of("r/late", "r/late", "response_p99", 0.005, MeasureUnit::kSeconds);
  EXPECT_FALSE(Judged(response).holds);
  EXPECT_EQ(Judged(response).what, "response_p99 was 0.005000001 s, expected at most 5 ms");
  response.most = 0.005000001;
  EXPECT_TRUE(Judged(response).holds);
  response.least = 0.006;
  response.most = 0.007;
  EXPECT_FALSE(Judged(response).holds);
}

TEST(JudgeRun, WhatIsNotKnownDoesNotHold) {
  for (const auto& [expected, why] : {
           std::pair{Of("r/free", "r/free", "misses", 5), "it has no deadline"},
           std::pair{Of("r/idle", "r/idle", "misses", 5), "no activation was judged"},
           std::pair{Of("r/idle", "r/idle", "response_max", 5), "it has no activation"},
           std::pair{Of("metric none", "none", "max", 5), "nobody told a value"},
           std::pair{Of("chain a->b", "chain a->b", "age_p99", 5), "no command acted"},
       }) {
    const Judgement judgement = Judged(expected);
    EXPECT_FALSE(judgement.holds) << expected.subject;
    EXPECT_FALSE(judgement.value.has_value());
    EXPECT_THAT(judgement.what, HasSubstr("is not known"));
    EXPECT_THAT(judgement.what, HasSubstr(why));
  }
  EXPECT_FALSE(JudgeRun({Of("r/late", "r/late", "misses", 9)}, "no JSON", {}).at(0).holds);
}

TEST(JudgeRun, FindsMetricsOfProgramsByTheirClient) {
  EXPECT_TRUE(Judged(Of("metric plan", "plan", "max", 1.5)).holds);
  EXPECT_TRUE(Judged(Of("metric r/late/plan", "r/late/plan", "max", 1.5)).holds);
  EXPECT_FALSE(Judged(Of("metric r/free/plan", "r/free/plan", "max", 1.5)).holds);
}

TEST(JudgeRun, LooksAtAllThatABodyDid) {
  ExpectationSpec height;
  height.subject = "body drone";
  height.figure = "z";
  height.kept = 0;
  height.least = 0.9;
  height.most = 1.1;
  MetricFigures figures;
  EXPECT_FALSE(Judged(height).holds);
  EXPECT_FALSE(Judged(height, {{"0", figures}}).holds);
  figures.count = 5;
  figures.min = 0.9;
  figures.max = 1.1;
  EXPECT_TRUE(Judged(height, {{"0", figures}}).holds);
  figures.min = 0.43;
  figures.first_time_ns = 3'120'000'000;
  EXPECT_EQ(Judged(height, {{"0", figures}}).what,
            "z was between 0.43 and 1.1, expected from 0.9 to 1.1, first left at 3.120 s");
}

TEST(Failed, BeginsWithTheEarliest) {
  const std::vector<Judgement> judgements = JudgeRun(
      {Of("r/free", "r/free", "misses", 0), Of("chain eye->hand", "chain eye->hand", "misses", 0),
       Of("r/late", "r/late", "misses", 0), Of("r/late", "r/late", "misses", 2)},
      kSummary, {});
  const auto failed = Failed(judgements);
  ASSERT_EQ(failed.size(), 3U);
  EXPECT_EQ(failed[0]->expected.subject, "r/late");
  EXPECT_EQ(failed[1]->expected.subject, "chain eye->hand");
  EXPECT_EQ(failed[2]->expected.subject, "r/free");
}

TEST(Expectations, AreReadAsTheyWereWritten) {
  const auto written = JudgeRun({Of("r/late", "r/late", "misses", 0)}, kSummary, {});
  const nlohmann::ordered_json summary{{"expectations", ExpectationsJson(written)}};
  const auto read = ExpectationsFromSummary(summary.dump());
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].expected.subject, "r/late");
  EXPECT_EQ(read[0].what, written[0].what);
  EXPECT_EQ(read[0].first_time_ns, 310'000'000);
  EXPECT_FALSE(read[0].holds);
}

}  // namespace
}  // namespace tcs
