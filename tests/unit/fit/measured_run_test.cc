#include "coordinator/fit/measured_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace tcs::fit {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class MeasuredRunTest : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static nlohmann::json Summary() {
    return {{"scenario", "chase"},
            {"accounting", "measured"},
            {"robots", {{"r", {{"cores", 1}, {"speed", 0.5}}}}},
            {"clients",
             {{"r/planner",
               {{"robot", "r"},
                {"charged_ns", 1100},
                {"priced_ns", 100},
                {"calls", 20},
                {"allocations", 30}}}}}};
  }
  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ + "/" + name) << text;
  }
  // With a table of such lines.
  LoadResult<MeasuredRun> Read(const nlohmann::json& summary, const std::string& lines) const {
    Write("summary.json", summary.dump());
    Write(
        "activations.csv",
        "client,thread,cause,release_ns,start_ns,end_ns,charged_ns,calls,allocations,priced_ns\n" +
            lines);
    return ReadMeasuredRun(folder_);
  }
  std::string Complaint(const LoadResult<MeasuredRun>& read) const {
    const auto* error = std::get_if<LoadError>(&read);
    return error == nullptr ? "" : error->message;
  }

  const std::string folder_ =
      testing::TempDir() + "fit_" + testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(MeasuredRunTest, HasEachClientsActivations) {
  const auto read =
      Read(Summary(), "r/planner,0,time,0,0,9,750,12,9,50\nr/planner,2,input,0,0,9,5,0,1,0\n");
  ASSERT_EQ(Complaint(read), "");
  const auto& run = std::get<MeasuredRun>(read);
  EXPECT_THAT(run.warnings, IsEmpty());
  const MeasuredClient& client = run.clients.at("r/planner");
  EXPECT_EQ(client.speed, 0.5);
  EXPECT_EQ(client.whole.charged_ns, 1000);
  EXPECT_EQ(client.whole.allocations, 30);
  ASSERT_EQ(client.activations.size(), 2u);
  EXPECT_EQ(client.activations[0].calls, 12);
  EXPECT_EQ(client.activations[1].charged_ns, 5);
}

TEST_F(MeasuredRunTest, LinesOfNoUseAreLeftOut) {
  const auto read = Read(Summary(),
                         "r/planner,0,time,0,0,9,700,12,9,0\n"
                         "r/planner,0,time,0,0,9,-700,12,9,0\n"
                         "r/planner,0,time,0,0,9,nan,12,9,0\n"
                         "r/planner,0,time,0,0,9,700,1e300,9,0\n"
                         "r/stranger,0,time,0,0,9,700,12,9,0\n"
                         "r/planner,0\n"
                         "\xff\xfe,,,\n"
                         "r/planner,0,time,0,0,9,700,1");
  ASSERT_EQ(Complaint(read), "");
  const auto& run = std::get<MeasuredRun>(read);
  EXPECT_EQ(run.clients.at("r/planner").activations.size(), 1u);
  EXPECT_THAT(run.warnings, ElementsAre(HasSubstr("7 lines that cannot be used; left out")));
}

TEST_F(MeasuredRunTest, WhatIsNoResultFolderIsSaid) {
  EXPECT_THAT(Complaint(ReadMeasuredRun("/nonexistent")),
              HasSubstr("/nonexistent has no summary.json: give the folder of a run"));
  Write("summary.json", "{\"scenario\": ");
  EXPECT_THAT(Complaint(ReadMeasuredRun(folder_)), HasSubstr("summary.json is damaged"));
  Write("summary.json", Summary().dump());
  EXPECT_THAT(Complaint(ReadMeasuredRun(folder_)), HasSubstr("activations.csv cannot be read"));
}

TEST_F(MeasuredRunTest, AFixedRunHasNothingToFit) {
  nlohmann::json summary = Summary();
  summary["accounting"] = "fixed";
  EXPECT_THAT(Complaint(Read(summary, "")), HasSubstr("charges were set, not measured"));
}

TEST_F(MeasuredRunTest, ARunWithoutCountsIsSaid) {
  nlohmann::json summary = Summary();
  summary["clients"]["r/planner"].erase("calls");
  EXPECT_THAT(Complaint(Read(summary, "")), HasSubstr("make the run again with --for-fit"));
}

TEST_F(MeasuredRunTest, CountsThatCannotBeAreNone) {
  nlohmann::json summary = Summary();
  summary["clients"]["r/planner"]["calls"] = -5;
  summary["clients"]["r/planner"]["allocations"] = 1e300;
  const auto read = Read(summary, "");
  ASSERT_EQ(Complaint(read), "");
  const Work& whole = std::get<MeasuredRun>(read).clients.at("r/planner").whole;
  EXPECT_EQ(whole.calls, 0);
  EXPECT_EQ(whole.allocations, 0);
}

}  // namespace
}  // namespace tcs::fit
