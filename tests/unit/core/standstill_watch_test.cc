#include "coordinator/core/standstill_watch.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tcs {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kPatience = StandstillWatch::kPatienceNs;

class StandstillWatchTest : public testing::Test {
 protected:
  // A program that the scenario names, and that waits for DDS messages.
  Process& AddClient(const std::string& name) {
    Task& task = run_.table.AddTask(0);
    Process& process = run_.table.AddProcess(0);
    process.name = name;
    process.is_client = true;
    process.robot = &robot_;
    task.process = &process;
    task.state = TaskState::kWaiting;
    task.wait = Wait{awaited::Messages{}};
    robot_.tasks.push_back(&task);
    return process;
  }
  RunOptions Telling() {
    RunOptions options;
    options.output_directory = "somewhere";
    options.on_notice = [this](const std::string& text) { told_.push_back(text); };
    return options;
  }

  std::vector<std::string> told_;
  Robot robot_{"robot", 1.0, RobotScheduler(1, true, [](int) { return RobotScheduler::Wait{}; })};
  RunState run_{Scenario{}, Telling(), false};
  Reactor reactor_;
  UnmanagedThreads unmanaged_{run_};
  UnknownChildren unknown_children_{run_.table, reactor_, unmanaged_};
  StandstillWatch watch_{run_, unmanaged_, unknown_children_};
};

TEST_F(StandstillWatchTest, SaysOnceWhatIsWaitedForWhenPatienceIsOver) {
  AddClient("planner");
  watch_.Look(kSecond, 2 * kSecond);
  watch_.Look(kSecond + kPatience - 1, 2 * kSecond);
  EXPECT_TRUE(told_.empty());
  watch_.Look(kSecond + kPatience, 2 * kSecond);
  ASSERT_EQ(told_.size(), 1u);
  EXPECT_EQ(told_[0],
            "virtual time has stood still at 2.000 s for 5 s: only input from outside could make "
            "it go on; planner waits for DDS messages; Ctrl-C ends the run");
  watch_.Look(kSecond + 3 * kPatience, 2 * kSecond);
  EXPECT_EQ(told_.size(), 1u);
}

TEST_F(StandstillWatchTest, SaysNothingWhileTimeGoesOnOrThreadsAreDispatched) {
  AddClient("planner");
  watch_.Look(0, 0);
  watch_.Look(kPatience, 1);
  ++run_.report.switches;
  watch_.Look(2 * kPatience, 1);
  EXPECT_TRUE(told_.empty());
}

TEST_F(StandstillWatchTest, WhatAClientHasLeftIsSaidOnlyOfProgramsThatRunForAsLongAsTheyTake) {
  AddClient("tool").dead = true;
  Process& left = run_.table.AddProcess(1);
  left.robot = &robot_;
  run_.end_ns = 60 * kSecond;
  watch_.Look(0, 0);
  watch_.Look(kPatience, kSecond);
  EXPECT_TRUE(told_.empty());
  run_.end_ns = shm::kNeverNs;
  watch_.Look(kPatience, kSecond);
  watch_.Look(2 * kPatience, 2 * kSecond);
  ASSERT_EQ(told_.size(), 1u);
  EXPECT_EQ(
      told_[0].find("tool has ended; the run goes on for the background processes that it has "
                    "left: "),
      0u);
}

}  // namespace
}  // namespace tcs
