// The earliest deadline first: among threads of SCHED_DEADLINE, and of clients that have a
// deadline.
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>

#include "tests/unit/policy/simulated_robot.h"

namespace tcs {
namespace {

constexpr SchedulingParameters kFifo{.policy = SCHED_FIFO, .priority = 99};

SchedulingParameters Deadline(std::int64_t runtime_ns, std::int64_t period_ns) {
  return {.policy = SCHED_DEADLINE,
          .deadline = {.runtime_ns = runtime_ns, .deadline_ns = period_ns, .period_ns = period_ns}};
}

// A thread runs, and another one sleeps: how far the first may run.
struct EdfCase {
  const char* name;
  SchedulingParameters running, other;
  RobotScheduler::Wait wait;
  std::int64_t horizon_ns;
};

std::ostream& operator<<(std::ostream& out, const EdfCase& test) { return out << test.name; }

class DeadlineHorizon : public testing::TestWithParam<EdfCase> {};

TEST_P(DeadlineHorizon, IsWhereAnEarlierDeadlineBegins) {
  SimulatedRobot robot;
  robot.AddReady(kOne, GetParam().running);
  robot.Add(kTwo, GetParam().other);
  robot.Sleep(kTwo, GetParam().wait);
  EXPECT_EQ(robot.Horizon({.input = RobotTime(3 * kMilli), .acts_at_once = true}),
            GetParam().horizon_ns);
}

const EdfCase kEdfCases[] = {
    {"AnEarlierOneWakes",
     Deadline(8 * kMilli, 20 * kMilli),
     Deadline(kMilli, 10 * kMilli),
     {.until = RobotTime(4 * kMilli)},
     4 * kMilli},
    {"ALaterOneWakes",
     Deadline(8 * kMilli, 20 * kMilli),
     Deadline(kMilli, 10 * kMilli),
     {.until = RobotTime(12 * kMilli)},
     8 * kMilli},
    {"AnEqualOneWakes",
     Deadline(8 * kMilli, 20 * kMilli),
     Deadline(kMilli, 16 * kMilli),
     {.until = RobotTime(4 * kMilli)},
     8 * kMilli},
    {"AnEarlierOneReads",
     Deadline(8 * kMilli, 20 * kMilli),
     Deadline(kMilli, 10 * kMilli),
     {.for_input = true},
     3 * kMilli},
    {"ALaterOneReads",
     Deadline(8 * kMilli, 20 * kMilli),
     Deadline(kMilli, 18 * kMilli),
     {.for_input = true},
     8 * kMilli},
    {"ALaterOnesTimerIsInTime",
     Deadline(8 * kMilli, 20 * kMilli),
     Deadline(kMilli, 18 * kMilli),
     {.next_expiry = RobotTime(4 * kMilli)},
     4 * kMilli},
    {"FifoWakes",
     Deadline(8 * kMilli, 20 * kMilli),
     kFifo,
     {.until = RobotTime(kMilli)},
     8 * kMilli},
    {"FifoIsPreempted", kFifo, Deadline(kMilli, 10 * kMilli), {.until = RobotTime(kMilli)}, kMilli},
    {"OrdinaryIsPreempted",
     kOrdinary,
     Deadline(kMilli, 10 * kMilli),
     {.until = RobotTime(kMilli)},
     kMilli},
};

INSTANTIATE_TEST_SUITE_P(Where, DeadlineHorizon, testing::ValuesIn(kEdfCases),
                         testing::PrintToStringParamName());

TEST(EarliestDeadlineFirst, WhoHasUsedUpItsBudgetRunsInItsNextPeriod) {
  SimulatedRobot robot;
  robot.AddReady(kOne, Deadline(3 * kMilli, 10 * kMilli));
  robot.AddReady(kTwo);
  std::int64_t had = 0;
  while (robot.Progress() < 100 * kMilli) {
    const std::int64_t ns = std::min(robot.Horizon(), 100 * kMilli) - robot.Progress();
    had += robot.Next() == kOne ? ns : 0;
    robot.Run(ns);
  }
  EXPECT_EQ(had, 30 * kMilli);
}

TEST(EarliestDeadlineFirst, AClientsReleasesAreOrderedByTheirDeadlines) {
  SimulatedRobot robot;
  robot.Add(kOne, {}, 99);
  robot.Add(kTwo);
  robot.scheduler.SetClientDeadline(kOne, VirtualNs(10 * kMilli), RobotTime(0));
  robot.scheduler.SetClientDeadline(kTwo, VirtualNs(7 * kMilli), RobotTime(0));
  robot.Wake(kOne, 0, false);
  robot.Wake(kTwo, 2 * kMilli, false);
  robot.ComeTo(0, 2 * kMilli);
  EXPECT_EQ(robot.Next(), kTwo) << "9 ms are before 10 ms, whatever the priorities";
  robot.Sleep(kTwo, {.until = RobotTime(4 * kMilli)});
  EXPECT_EQ(robot.Next(), kOne);
  EXPECT_EQ(robot.Horizon(), kNever) << "the next deadline is at 11 ms";
}

TEST(EarliestDeadlineFirst, WhatItsOwnRobotWakesKeepsItsDeadline) {
  SimulatedRobot robot;
  robot.Add(kOne);
  robot.scheduler.SetClientDeadline(kOne, VirtualNs(10 * kMilli), RobotTime(0));
  const RobotScheduler::Priority before = robot.scheduler.PriorityOf(kOne);
  robot.scheduler.WakeUp(kOne, RobotTime(4 * kMilli), false);
  EXPECT_EQ(robot.scheduler.PriorityOf(kOne), before);
  robot.scheduler.WakeUp(kOne, RobotTime(4 * kMilli), true);
  EXPECT_LT(robot.scheduler.PriorityOf(kOne), before);
}

TEST(EarliestDeadlineFirst, ADeadlineIsInherited) {
  SimulatedRobot robot;
  robot.AddReady(kOne);
  robot.AddReady(3, kFifo);
  robot.Add(kTwo, Deadline(kMilli, 10 * kMilli));
  robot.Sleep(kTwo, {});
  EXPECT_EQ(robot.Next(), 3);
  robot.scheduler.SetBlockedOn(kTwo, kOne);
  EXPECT_TRUE(robot.scheduler.FindEffectivePriority(kOne));
  robot.scheduler.Assign(RobotTime(kNever));
  EXPECT_EQ(robot.Next(), kOne);
}

TEST(EarliestDeadlineFirst, ARobotPromisesNoMoreThanItsCoresHave) {
  SimulatedRobot robot(2);
  robot.Add(kOne, Deadline(9 * kMilli, 10 * kMilli));
  robot.Add(kTwo);
  EXPECT_TRUE(robot.scheduler.Admits(kTwo, Deadline(10 * kMilli, 10 * kMilli).deadline));
  EXPECT_FALSE(robot.scheduler.Admits(kTwo, Deadline(21 * kMilli, 20 * kMilli).deadline));
  EXPECT_TRUE(robot.scheduler.Admits(kOne, Deadline(19 * kMilli, 10 * kMilli).deadline))
      << "instead of what it has";
}

TEST(EarliestDeadlineFirst, AChildHasNoDeadlineOfItsOwn) {
  SimulatedRobot robot;
  robot.Add(kOne, Deadline(kMilli, 10 * kMilli));
  robot.Add(kTwo);
  robot.scheduler.Inherit(kTwo, kOne);
  EXPECT_EQ(robot.scheduler.ParametersOf(kTwo).policy, SCHED_OTHER);
}

}  // namespace
}  // namespace tcs
