#include "coordinator/trials/outcome.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

std::string Summary(const char* interrupted, const char* seed, const char* ended,
                    const char* status) {
  return std::string(R"({"scenario": "s", "interrupted": )") + interrupted + R"(, "seed": )" +
         seed +
         R"(, "virtual_ns": 20, "real_ns": 10, "drift_ns": 3, "staleness_ns": 4,
            "overhead_percent": 1.5, "clients": {"r/good": {"ended_at_ns": -1, "wait_status": 0},
            "r/c": {"ended_at_ns": )" +
         ended + R"(, "wait_status": )" + status + "}}}";
}

TEST(TrialOutcomeTest, IsReadFromASummary) {
  const auto outcome = OutcomeFromJson(Summary("false", "7", "-1", "0"), 7);
  ASSERT_TRUE(outcome.has_value());
  EXPECT_EQ(outcome->virtual_ns, 20);
  EXPECT_EQ(outcome->real_ns, 10);
  EXPECT_EQ(outcome->drift_ns, 3);
  EXPECT_EQ(outcome->staleness_ns, 4);
  EXPECT_EQ(outcome->overhead_percent, 1.5);
}

TEST(TrialOutcomeTest, AClientMayEndEarlyIfItEndsWell) {
  EXPECT_TRUE(OutcomeFromJson(Summary("false", "7", "5", "0"), 7).has_value());
  EXPECT_FALSE(OutcomeFromJson(Summary("false", "7", "5", "256"), 7).has_value());
}

TEST(TrialOutcomeTest, ARunThatWasInterruptedIsToBeRunAgain) {
  EXPECT_FALSE(OutcomeFromJson(Summary("true", "7", "-1", "0"), 7).has_value());
}

TEST(TrialOutcomeTest, ASummaryOfAnotherSeedIsNone) {
  EXPECT_FALSE(OutcomeFromJson(Summary("false", "8", "-1", "0"), 7).has_value());
}

TEST(TrialOutcomeTest, HalfASummaryIsNone) {
  const std::string whole = Summary("false", "7", "-1", "0");
  EXPECT_FALSE(OutcomeFromJson(whole.substr(0, whole.size() / 2), 7).has_value());
  EXPECT_FALSE(OutcomeFromJson("", 7).has_value());
  EXPECT_FALSE(OutcomeFromJson("{}", 7).has_value());
  EXPECT_FALSE(ReadOutcome("/no/such/folder", 7).has_value());
}

TEST(TrialLastWords, AreTheSentenceNotTheTable) {
  EXPECT_EQ(LastWords("tcsim: other runs of tcsim have the processors; waiting for one of them\n"
                      "tcsim: r/c ended at 0.1 s with exit status 1\n"
                      "tcsim: warning: something else\n"
                      "0.1 s of virtual time\nwritten to out\n"),
            "r/c ended at 0.1 s with exit status 1");
}

TEST(TrialLastWords, AreTheLastLineWhereThereIsNoSentence) {
  EXPECT_EQ(LastWords("first\nterminate called after\n\n"), "terminate called after");
  EXPECT_EQ(LastWords(""), "");
}

TEST(TrialLastWords, WarningsAreNoReason) {
  EXPECT_EQ(LastWords("tcsim: warning: channel thrust: nothing came in\n"), "");
}

TEST(TrialLastWords, ARunThatOnlyWaitedForAProcessorSaidNothing) {
  EXPECT_EQ(LastWords("tcsim: other runs of tcsim have the processors; waiting for one of them\n"),
            "");
}

}  // namespace
}  // namespace tcs
