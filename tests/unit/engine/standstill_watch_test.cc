#include "coordinator/engine/standstill_watch.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace tcs {
namespace {

constexpr HostDuration kPatience = StandstillWatch::kPatience,
                       kHostSecond = HostDuration::Seconds(1);
constexpr VirtualTime kOneSecond = VirtualTime() + VirtualDuration::Seconds(1),
                      kTwoSeconds = VirtualTime() + VirtualDuration::Seconds(2);

constexpr HostTime HostAt(HostDuration since_start) { return HostTime() + since_start; }

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
    options.on_notice = [this](const std::string& text) { told_.push_back(text); };
    return options;
  }

  // Looks now and then, as a run does, from the first time to the last one.
  void LookUntil(HostDuration first, HostDuration last, VirtualTime furthest) {
    for (HostDuration at = first; at < last; at += kHostSecond) watch_.Look(HostAt(at), furthest);
    watch_.Look(HostAt(last), furthest);
  }

  std::vector<std::string> told_;
  Robot robot_{"robot", 1.0, RobotScheduler(1, true, [](int) { return RobotScheduler::Wait{}; })};
  RunState run_{Scenario{}, Telling(), false};
  Reactor reactor_;
  UnregisteredThreads unregistered_{run_};
  UnregisteredChildren unregistered_children_{run_.table, reactor_, unregistered_};
  StandstillWatch watch_{run_, unregistered_, unregistered_children_};
};

TEST_F(StandstillWatchTest, SaysOnceWhatIsWaitedForWhenPatienceIsOver) {
  AddClient("planner");
  LookUntil(kHostSecond, kHostSecond + kPatience - HostNs(1), kTwoSeconds);
  EXPECT_TRUE(told_.empty());
  watch_.Look(HostAt(kHostSecond + kPatience), kTwoSeconds);
  ASSERT_EQ(told_.size(), 1u);
  EXPECT_EQ(told_[0],
            "virtual time has stood still at 2.000 s for 5 s: only input from outside could make "
            "it go on; planner waits for DDS messages; Ctrl-C ends the run");
  LookUntil(kHostSecond + kPatience, kHostSecond + 3 * kPatience, kTwoSeconds);
  EXPECT_EQ(told_.size(), 1u);
}

TEST_F(StandstillWatchTest, TimeInWhichTheRunItselfHadNoProcessorIsNoStandstill) {
  AddClient("planner");
  watch_.Look(HostAt({}), kOneSecond);
  watch_.Look(HostAt(3 * kPatience), kOneSecond);
  EXPECT_TRUE(told_.empty());
  LookUntil(3 * kPatience, 4 * kPatience, kOneSecond);
  EXPECT_EQ(told_.size(), 1u);
}

TEST_F(StandstillWatchTest, SaysNothingWhileTimeGoesOnOrThreadsAreDispatched) {
  AddClient("planner");
  watch_.Look(HostAt({}), {});
  LookUntil(kHostSecond, kPatience, RobotTime(1));
  ++run_.report.switches;
  LookUntil(kPatience, 2 * kPatience - HostNs(1), RobotTime(1));
  EXPECT_TRUE(told_.empty());
}

TEST_F(StandstillWatchTest, TimeThatAUserTakesToTypeIsNoStandstill) {
  AddClient("head");
  std::optional<Wait>& wait = robot_.tasks.back()->wait;
  wait = Wait{awaited::Descriptors{.has_terminal = true}};
  LookUntil({}, 3 * kPatience, kOneSecond);
  // It has been typed, and the program has yet to be dispatched.
  wait.reset();
  watch_.Look(HostAt(3 * kPatience + HostNs(1)), kOneSecond);
  EXPECT_TRUE(told_.empty());
  LookUntil(3 * kPatience + HostNs(1), 4 * kPatience + HostNs(1), kOneSecond);
  EXPECT_EQ(told_.size(), 1u);
}

TEST_F(StandstillWatchTest, WhatAClientHasLeftIsSaidOnlyOfProgramsThatRunForAsLongAsTheyTake) {
  AddClient("tool").dead = true;
  Process& left = run_.table.AddProcess(1);
  left.robot = &robot_;
  run_.end = VirtualTime() + VirtualDuration::Seconds(60);
  watch_.Look(HostAt({}), {});
  watch_.Look(HostAt(kPatience), kOneSecond);
  EXPECT_TRUE(told_.empty());
  run_.end = VirtualTime::Never();
  watch_.Look(HostAt(kPatience), kOneSecond);
  watch_.Look(HostAt(2 * kPatience), kTwoSeconds);
  ASSERT_EQ(told_.size(), 1u);
  EXPECT_EQ(
      told_[0].find("tool has ended; the run goes on for the background processes that it has "
                    "left: "),
      0u);
}

}  // namespace
}  // namespace tcs
