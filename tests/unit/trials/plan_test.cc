#include "coordinator/trials/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tcs {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TrialsPlan ThreeTrials() {
  TrialsPlan plan;
  plan.scenario = "/home/me/chase.yaml";
  plan.name = "chase";
  plan.trials = 3;
  return plan;
}

std::vector<std::string> FoldersOf(const TrialsPlan& plan) {
  std::vector<std::string> folders;
  for (const Trial& trial : TrialsOf(plan)) folders.push_back(trial.folder);
  return folders;
}

TEST(TrialsPlanTest, TrialsHaveConsecutiveSeeds) {
  TrialsPlan plan = ThreeTrials();
  plan.first_seed = 9;
  EXPECT_THAT(FoldersOf(plan), ElementsAre("seed-0009", "seed-0010", "seed-0011"));
  EXPECT_EQ(TrialsOf(plan)[2].seed, 11u);
}

TEST(TrialsPlanTest, TheLargestSeedsFitIntoAName) {
  TrialsPlan plan = ThreeTrials();
  plan.trials = 1;
  plan.first_seed = ~std::uint64_t{0};
  EXPECT_THAT(FoldersOf(plan), ElementsAre("seed-18446744073709551615"));
}

TEST(TrialsPlanTest, EachValueHasAllSeedsAndTheValuesTakeTurns) {
  TrialsPlan plan = ThreeTrials();
  plan.trials = 2;
  plan.vary = {Vary{"drift", {"1ms", "2ms"}}};
  EXPECT_THAT(FoldersOf(plan),
              ElementsAre("1ms/seed-0001", "2ms/seed-0001", "1ms/seed-0002", "2ms/seed-0002"));
  EXPECT_THAT(GroupLabels(plan), ElementsAre("drift=1ms", "drift=2ms"));
  EXPECT_EQ(TrialsOf(plan)[3].group, 1u);
}

TEST(TrialsPlanTest, AGridHasEachValueOfOneKeyWithEachOfTheOthers) {
  TrialsPlan plan = ThreeTrials();
  plan.trials = 1;
  plan.options.set = {"a=1"};
  plan.vary = {Vary{"drift", {"1ms", "2ms"}}, Vary{"x/y", {"../b", "c"}}};
  EXPECT_THAT(FoldersOf(plan), ElementsAre("1ms,_._b/seed-0001", "1ms,c/seed-0001",
                                           "2ms,_._b/seed-0001", "2ms,c/seed-0001"));
  EXPECT_THAT(GroupLabels(plan), ElementsAre("drift=1ms x/y=../b", "drift=1ms x/y=c",
                                             "drift=2ms x/y=../b", "drift=2ms x/y=c"));
  EXPECT_THAT(SettingsOf(plan, 2), ElementsAre("a=1", "drift=2ms", "x/y=../b"));
  EXPECT_EQ(GroupCount(plan), 4u);
}

TEST(TrialsPlanTest, AValueIsAFolderInsideTheResults) {
  TrialsPlan plan = ThreeTrials();
  plan.trials = 1;
  plan.vary = {Vary{"key", {"../../etc", ".", "a b", "-1e3"}}};
  EXPECT_THAT(FoldersOf(plan),
              ElementsAre("_._.._etc/seed-0001", "_/seed-0001", "a b/seed-0001", "-1e3/seed-0001"));
}

TEST(TrialsPlanTest, ARunIsToldWhatTheTrialsWere) {
  TrialsPlan plan = ThreeTrials();
  plan.options = {"callback", "fixed", "20s", "", {"a=1", "b=2"}};
  EXPECT_THAT(RunArgumentsOf(plan, TrialsOf(plan)[1]),
              ElementsAre("run", "/home/me/chase.yaml", "--seed", "2", "--host-cpus", "1", "--sync",
                          "callback", "--accounting", "fixed", "--duration", "20s", "--set", "a=1",
                          "--set", "b=2"));
}

TEST(TrialsPlanTest, ARunIsToldItsValue) {
  TrialsPlan plan = ThreeTrials();
  plan.vary = {Vary{"robots.predator.cpu.speed", {"0.25", "8"}}};
  const std::vector<std::string> words = RunArgumentsOf(plan, TrialsOf(plan)[1]);
  EXPECT_EQ(words.back(), "robots.predator.cpu.speed=8");
  EXPECT_EQ(words[words.size() - 2], "--set");
}

TEST(TrialsVary, IsAKeyAndItsValues) {
  Vary vary;
  ASSERT_EQ(ParseVary("drift=1ms,10ms", &vary), "");
  EXPECT_EQ(vary.key, "drift");
  EXPECT_THAT(vary.values, ElementsAre("1ms", "10ms"));
}

TEST(TrialsVary, AnythingElseIsRefusedWithAnExample) {
  for (const char* text : {"drift", "drift=", "=1ms", "drift=1ms,", "drift=,1ms", ""}) {
    Vary vary;
    EXPECT_THAT(ParseVary(text, &vary), HasSubstr("write it like drift=1ms,10ms")) << text;
  }
}

TEST(TrialsVary, TheSeedIsNotVariedTwice) {
  Vary vary;
  EXPECT_THAT(ParseVary("seed=1,2", &vary), HasSubstr("--first-seed"));
}

TEST(TrialsVary, TwoValuesDoNotShareAFolder) {
  Vary vary;
  EXPECT_THAT(ParseVary("key=a/b,a_b", &vary), HasSubstr("'a_b' would have the same folder"));
}

TEST(TrialsVary, AnOptionThatWouldOutdoTheValuesIsNamed) {
  TrialsPlan plan = ThreeTrials();
  plan.options = {"consistent", "measured", "20s", "", {"seed=3", "drifting=1"}};
  plan.vary = {Vary{"drift", {"1ms"}}};
  EXPECT_EQ(WhatHidesValues(plan), "");
  plan.options.drift = "2ms";
  EXPECT_THAT(WhatHidesValues(plan), HasSubstr("--vary drift and --drift set the same"));
  plan.vary[0].key = "duration";
  EXPECT_THAT(WhatHidesValues(plan), HasSubstr("and --duration set the same"));
  plan.vary[0].key = "seed";
  EXPECT_THAT(WhatHidesValues(plan), HasSubstr("and --set set the same"));
}

TEST(TrialsVary, KeysThatOutdoEachOtherAreNamed) {
  TrialsPlan plan = ThreeTrials();
  plan.vary = {Vary{"robots.a.cpu", {"1"}}, Vary{"robots.a.cpu.speed", {"1"}}};
  EXPECT_THAT(WhatHidesValues(plan),
              HasSubstr("--vary robots.a.cpu.speed and --vary robots.a.cpu set the same"));
  plan.vary[1].key = "robots.a.cpus";
  EXPECT_EQ(WhatHidesValues(plan), "");
  plan.vary[1].key = "robots.a.cpu";
  EXPECT_THAT(WhatHidesValues(plan), HasSubstr("set the same thing"));
}

}  // namespace
}  // namespace tcs
