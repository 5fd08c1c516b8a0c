// The schedule that a run has written is read again as it was.
#include "coordinator/perfetto/schedule.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include "coordinator/trace/schedule_trace.h"

namespace tcs::perfetto {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

class ScheduleTest : public testing::Test {
 protected:
  ScheduleTest()
      : path_(testing::TempDir() + "schedule_" +
              testing::UnitTest::GetInstance()->current_test_info()->name() + ".json") {}
  ~ScheduleTest() override { std::remove(path_.c_str()); }

  // Of a robot with two clients, one of which has three threads.
  Schedule Written() {
    ScheduleTrace trace;
    EXPECT_EQ(trace.Open(path_), "");
    const int world = trace.AddRow("dynamics", "dynamics");
    const int first = trace.AddRow("r", "r/a"), other = trace.AddRow("r", "r/ab");
    const int second = trace.AddRow("r", "r/a #2"), third = trace.AddRow("r", "r/a #3");
    trace.Slice(world, 0, 1000);
    trace.Slice(first, 0, 10);
    trace.Slice(other, 0, 30);
    trace.Slice(second, 10, 20);
    trace.Slice(third, 20, 30);
    trace.Slice(first, 40, 1'234'567);
    trace.Instant(world, "sensors", 7);
    EXPECT_EQ(trace.Close(), "");
    return Read();
  }
  Schedule Read() {
    auto read = Schedule::Read(path_);
    if (const auto* error = std::get_if<LoadError>(&read)) ADD_FAILURE() << error->message;
    return std::move(std::get<Schedule>(read));
  }
  std::string Complaint(const std::string& text) {
    std::ofstream(path_) << text;
    const auto read = Schedule::Read(path_);
    const auto* error = std::get_if<LoadError>(&read);
    return error == nullptr ? "" : error->message;
  }

  const std::string path_;
};

TEST_F(ScheduleTest, HasEachRowWithItsSlices) {
  const Schedule schedule = Written();
  EXPECT_EQ(schedule.last_pid(), 2);
  ASSERT_NE(schedule.Find("r/a"), nullptr);
  EXPECT_EQ(schedule.Find("r/a")->pid, 2);
  EXPECT_EQ(schedule.Find("r/a #3")->tid, 5);
  EXPECT_THAT(schedule.Find("r/a")->busy, ElementsAre(Pair(0, 10), Pair(40, 1'234'567)));
  EXPECT_EQ(schedule.Find("nobody"), nullptr);
}

TEST_F(ScheduleTest, AThreadSendsWhereItStopsAndReceivesWhereItBegins) {
  const Schedule schedule = Written();
  EXPECT_EQ(schedule.ThatStopped("r/a", 10), schedule.Find("r/a"));
  EXPECT_EQ(schedule.ThatBegan("r/a", 10), schedule.Find("r/a #2"));
  EXPECT_EQ(schedule.ThatStopped("r/a", 20), schedule.Find("r/a #2"));
  EXPECT_EQ(schedule.ThatBegan("r/a", 20), schedule.Find("r/a #3"));
}

TEST_F(ScheduleTest, ElseItIsTheOneThatWasBusyOrTheFirst) {
  const Schedule schedule = Written();
  EXPECT_EQ(schedule.ThatStopped("r/a", 25), schedule.Find("r/a #3"));
  EXPECT_EQ(schedule.ThatBegan("r/a", 35), schedule.Find("r/a"));
  EXPECT_EQ(schedule.ThatBegan("r/ab", 10), schedule.Find("r/ab"));
  EXPECT_EQ(schedule.ThatStopped("r/b", 10), nullptr);
}

TEST_F(ScheduleTest, WithoutSlicesItIsEmptyAndSound) {
  ScheduleTrace trace;
  ASSERT_EQ(trace.Open(path_), "");
  ASSERT_EQ(trace.Close(), "");
  EXPECT_EQ(Read().events(), "");
}

TEST_F(ScheduleTest, WhatIsNoScheduleIsSaidInASentence) {
  for (const char* text : {"", "nonsense", "{\"traceEvents\":[]}", "{\"displayTimeUnit\":\"ms\""}) {
    EXPECT_THAT(Complaint(text), HasSubstr("is no schedule of a run")) << text;
  }
  // Lines that are cut off, or say nothing of use, are none of a row's.
  EXPECT_EQ(
      Complaint("{\"displayTimeUnit\":\"ms\",\"traceEvents\":[\n{\"ph\":\"M\",\"name\":\"thread_"
                "name\",\"pid\":1,\"tid\":\n{\"ph\":\"X\",\"pid\":1,\"tid\":7,\"ts\":1.\n\n]}\n"),
      "");
}

}  // namespace
}  // namespace tcs::perfetto
