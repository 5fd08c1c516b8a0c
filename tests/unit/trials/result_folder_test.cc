#include "coordinator/trials/result_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "coordinator/trials/outcome.h"

namespace tcs {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class TrialsFolderTest : public ::testing::Test {
 protected:
  TrialsFolderTest() {
    std::string made = ::testing::TempDir() + "trials.XXXXXX";
    folder_ = fs::path(mkdtemp(made.data())) / "out";
    record_.plan.scenario = "/s.yaml";
    record_.plan.trials = 2;
    record_.programs = {{"/planner", "11"}};
  }
  ~TrialsFolderTest() override { fs::remove_all(folder_.parent_path()); }

  // As one call of tcsim does it.
  std::string Enter(bool restart = false) {
    ResultFolder entered;
    std::string error = EnterResultFolder(folder_, restart, record_, &entered);
    has_trials_ = entered.has_trials;
    changed_ = entered.changed_program;
    return error;
  }
  void Put(const std::string& name) {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << "text";
  }
  bool Has(const std::string& name) { return fs::exists(folder_ / name); }

  fs::path folder_;
  TrialsRecord record_;
  bool has_trials_ = false;
  std::string changed_;
};

TEST_F(TrialsFolderTest, IsMadeWithItsRecord) {
  EXPECT_EQ(Enter(), "");
  EXPECT_FALSE(has_trials_);
  EXPECT_EQ(ReadText(folder_ / "trials.json"), ToJson(record_));
}

TEST_F(TrialsFolderTest, IsTakenUpWithMoreTrials) {
  ASSERT_EQ(Enter(), "");
  Put("seed-0001/summary.json");
  record_.plan.trials = 3;
  EXPECT_EQ(Enter(), "");
  EXPECT_TRUE(has_trials_);
  EXPECT_TRUE(Has("seed-0001/summary.json"));
  EXPECT_THAT(ReadText(folder_ / "trials.json"), HasSubstr("\"trials\": 3"));
}

TEST_F(TrialsFolderTest, OfOtherOptionsIsLeftAsItIs) {
  ASSERT_EQ(Enter(), "");
  const std::string before = ReadText(folder_ / "trials.json");
  record_.plan.options.sync = "callback";
  const std::string error = Enter();
  EXPECT_THAT(error, HasSubstr("was made with --sync consistent, not callback; choose another"));
  EXPECT_THAT(error, HasSubstr("--restart"));
  EXPECT_EQ(ReadText(folder_ / "trials.json"), before);
}

TEST_F(TrialsFolderTest, RestartThrowsTheTrialsAwayAndNothingElse) {
  ASSERT_EQ(Enter(), "");
  for (const char* name : {"seed-0001/summary.json", "1ms/seed-0001/x", "notes.txt", "seed-mine/x",
                           "other/seed-1/x", "other/x"}) {
    Put(name);
  }
  record_.plan.options.sync = "callback";
  EXPECT_EQ(Enter(true), "");
  EXPECT_FALSE(Has("seed-0001"));
  EXPECT_FALSE(Has("1ms"));
  EXPECT_FALSE(Has("other/seed-1"));
  for (const char* name : {"notes.txt", "seed-mine/x", "other/x"}) EXPECT_TRUE(Has(name)) << name;
  EXPECT_EQ(ReadText(folder_ / "trials.json"), ToJson(record_));
}

TEST_F(TrialsFolderTest, SomebodyElsesFolderIsRefusedEvenForARestart) {
  Put("seed-0001/thesis.tex");
  EXPECT_THAT(Enter(), HasSubstr("holds other files than trials"));
  EXPECT_THAT(Enter(true), HasSubstr("holds other files than trials"));
  EXPECT_TRUE(Has("seed-0001/thesis.tex"));
}

TEST_F(TrialsFolderTest, WhatACallLeftThatWasKilledWhileItWroteIsNoHindrance) {
  Put("trials.json.new");
  EXPECT_EQ(Enter(), "");
}

TEST_F(TrialsFolderTest, ABrokenRecordIsNamedAndKept) {
  Put("trials.json");
  EXPECT_THAT(Enter(), HasSubstr("trials.json is not what tcsim wrote"));
  EXPECT_EQ(ReadText(folder_ / "trials.json"), "text");
}

TEST_F(TrialsFolderTest, ServesOneAtATime) {
  ResultFolder held;
  ASSERT_EQ(EnterResultFolder(folder_, false, record_, &held), "");
  EXPECT_THAT(Enter(), HasSubstr("another tcsim trials is at work in"));
  EXPECT_THAT(Enter(true), HasSubstr("another tcsim trials is at work in"));
  held = {};
  EXPECT_EQ(Enter(), "");
}

TEST_F(TrialsFolderTest, AProgramThatChangesIsToldOfAtEachCall) {
  ASSERT_EQ(Enter(), "");
  record_.programs["/planner"] = "12";
  for (int call = 0; call < 2; ++call) {
    EXPECT_EQ(Enter(), "");
    EXPECT_EQ(changed_, "/planner");
  }
  EXPECT_EQ(Enter(true), "");
  EXPECT_EQ(changed_, "");
}

}  // namespace
}  // namespace tcs
