// Bounds over trials: how many held, and how sure that is.
#include "coordinator/expect/over_trials.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace tcs {
namespace {

using testing::HasSubstr;

// Of published tables, and closed forms: of no failure in n trials (alpha/2)^(1/n).
TEST(ClopperPearson, IsExact) {
  EXPECT_NEAR(ClopperPearson(30, 30).low, std::pow(0.025, 1.0 / 30), 1e-9);
  EXPECT_EQ(ClopperPearson(30, 30).high, 1);
  EXPECT_EQ(ClopperPearson(0, 10).low, 0);
  EXPECT_NEAR(ClopperPearson(0, 10).high, 1 - std::pow(0.025, 0.1), 1e-9);
  EXPECT_NEAR(ClopperPearson(5, 10).low, 0.1871, 1e-4);
  EXPECT_NEAR(ClopperPearson(5, 10).high, 0.8129, 1e-4);
  EXPECT_NEAR(ClopperPearson(50'000, 100'000).low, 0.5 - 1.96 * 0.0015811, 1e-5);
  EXPECT_EQ(ClopperPearson(0, 0).high, 1);
}

Judgement Trial(bool holds) {
  Judgement judgement;
  judgement.expected.subject = "r/c";
  judgement.expected.figure = "misses";
  judgement.holds = holds;
  judgement.what = holds ? "misses was 0" : "misses was 17";
  return judgement;
}

TEST(GroupJudge, WantsItsShareOfTheTrials) {
  ExpectationSpec expected;
  expected.subject = "r/c";
  expected.figure = "misses";
  expected.unit = MeasureUnit::kCount;
  expected.most = 0;
  expected.share = 0.95;
  GroupJudge judge({expected}, "");
  EXPECT_FALSE(judge.judgements()[0].Holds());  // of no trials
  for (std::uint64_t seed = 1; seed <= 20; ++seed) judge.Add(seed, {Trial(seed != 7)});
  EXPECT_TRUE(judge.judgements()[0].Holds());
  judge.Add(21, {});  // it has not judged it
  EXPECT_FALSE(judge.judgements()[0].Holds());
  const std::string sentence = SentenceOf(judge.judgements()[0]);
  EXPECT_THAT(sentence, HasSubstr("held in 19 of 21 trials (95 % confidence: 69.6 % to 98.8 %"));
  EXPECT_THAT(sentence, HasSubstr("expected in 95 %; with seed 7 misses was 17"));
}

}  // namespace
}  // namespace tcs
