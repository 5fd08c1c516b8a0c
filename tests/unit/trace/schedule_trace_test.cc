#include "coordinator/trace/schedule_trace.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

namespace tcs {
namespace {

class ScheduleTraceTest : public ::testing::Test {
 protected:
  void SetUp() override {
    path_ = ::testing::TempDir() + "schedule_trace_" +
            ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".json";
    ASSERT_EQ(trace_.Open(path_), "");
  }
  void TearDown() override { std::remove(path_.c_str()); }

  // The events of one phase, in the file's order.
  std::vector<nlohmann::json> Events(const std::string& phase) {
    EXPECT_EQ(trace_.Close(), "");
    std::ifstream file(path_);
    std::vector<nlohmann::json> events;
    const auto document = nlohmann::json::parse(file);
    for (const auto& event : document.at("traceEvents")) {
      if (event.at("ph") == phase) events.push_back(event);
    }
    return events;
  }

  std::string path_;
  ScheduleTrace trace_;
};

TEST_F(ScheduleTraceTest, SlicesWithoutAGapBecomeOne) {
  const int planner = trace_.AddRow("predator", "planner");
  trace_.Slice(planner, 0, 1'000'000);
  trace_.Slice(planner, 1'000'000, 2'000'001);
  trace_.Slice(planner, 3'000'000, 3'500'000);
  const auto slices = Events("X");
  ASSERT_EQ(slices.size(), 2u);
  EXPECT_DOUBLE_EQ(slices[0].at("ts"), 0.0);
  EXPECT_DOUBLE_EQ(slices[0].at("dur"), 2000.001);
  EXPECT_DOUBLE_EQ(slices[1].at("ts"), 3000.0);
}

TEST_F(ScheduleTraceTest, ASliceThatTookNoTimeIsStillSeen) {
  const int controller = trace_.AddRow("predator", "controller");
  trace_.Slice(controller, 10'000'000, 10'000'000);
  trace_.Slice(controller, 20'000'000, 20'000'000);
  EXPECT_EQ(Events("X").size(), 2u);
}

TEST_F(ScheduleTraceTest, RowsOfOneGroupShareItsProcess) {
  trace_.AddRow("predator", "controller");
  trace_.AddRow("predator", "a \"quoted\" planner");
  trace_.AddRow("prey", "controller");
  const auto names = Events("M");
  ASSERT_EQ(names.size(), 5u) << "two processes and three threads";
  EXPECT_EQ(names[1].at("pid"), names[2].at("pid"));
  EXPECT_EQ(names[2].at("args").at("name"), "a \"quoted\" planner");
  EXPECT_NE(names[4].at("pid"), names[2].at("pid"));
}

TEST_F(ScheduleTraceTest, AnInstantIsOnItsRow) {
  const int dynamics = trace_.AddRow("dynamics", "world");
  trace_.Instant(dynamics, "sensors", 10'000'000);
  const auto instants = Events("i");
  ASSERT_EQ(instants.size(), 1u);
  EXPECT_DOUBLE_EQ(instants[0].at("ts"), 10'000.0);
}

TEST(ScheduleTraceErrors, AFolderThatIsNotThereIsSaid) {
  ScheduleTrace trace;
  EXPECT_NE(trace.Open("/nonexistent/trace.json").find("/nonexistent/trace.json"),
            std::string::npos);
}

TEST(ScheduleTraceErrors, WithoutAFileNothingIsWritten) {
  ScheduleTrace trace;
  trace.Slice(trace.AddRow("a", "b"), 0, 1);
  EXPECT_EQ(trace.Close(), "");
}

}  // namespace
}  // namespace tcs
