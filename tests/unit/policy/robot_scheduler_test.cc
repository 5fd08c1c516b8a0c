// Wake-up preemption, quanta, fair shares, effective priorities, and which thread has which core.
#include "coordinator/policy/robot_scheduler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <ostream>

#include "tests/unit/policy/simulated_robot.h"

namespace tcs {
namespace {

constexpr int kThree = 3, kNobody = RobotScheduler::kNobody;

// Two threads that compute without end, on one core: how long the first one runs until the other
// one has its turn, if it ever does.
struct QuantumCase {
  const char* name;
  SchedulingParameters first, second;
  std::int64_t quantum_ns;
};

std::ostream& operator<<(std::ostream& out, const QuantumCase& test) { return out << test.name; }

class Quantum : public testing::TestWithParam<QuantumCase> {};

TEST_P(Quantum, EndsTheTurnOfTheFirst) {
  SimulatedRobot robot;
  robot.AddReady(kOne, GetParam().first);
  robot.AddReady(kTwo, GetParam().second);
  ASSERT_EQ(robot.Next(), kOne);
  EXPECT_EQ(robot.Horizon(), GetParam().quantum_ns);
  const std::int64_t step =
      GetParam().quantum_ns == kNever ? 1000 * kMilli : GetParam().quantum_ns / 2;
  robot.Run(step);
  EXPECT_EQ(robot.Next(), kOne);
  robot.Run(step);
  EXPECT_EQ(robot.Next(), GetParam().quantum_ns == kNever ? kOne : kTwo);
}

const QuantumCase kQuanta[] = {
    {"Ordinary", kOrdinary, kOrdinary, kMilli},
    {"Batch", kBatch, kBatch, kMilli},
    {"Idle", kIdle, kIdle, kMilli},
    {"RoundRobin", kRoundRobin, kRoundRobin, 100 * kMilli},
    {"RoundRobinBesideFifo", kRoundRobin, kFifo50, 100 * kMilli},
    {"Fifo", kFifo50, kFifo50, kNever},
    {"FifoBesideRoundRobin", kFifo50, kRoundRobin, kNever},
    {"MoreUrgent", kFifo60, kFifo50, kNever},
    {"OrdinaryBeforeIdle", kOrdinary, kIdle, kNever},
};

INSTANTIATE_TEST_SUITE_P(Of, Quantum, testing::ValuesIn(kQuanta),
                         testing::PrintToStringParamName());

// A thread that sleeps beside one that computes: whether it preempts that one when it wakes, after
// each of them has run for so long.
struct WakeupCase {
  const char* name;
  SchedulingParameters sleeper;
  std::int64_t sleeper_ran_ns, other_ran_ns;
  bool preempts;
};

std::ostream& operator<<(std::ostream& out, const WakeupCase& test) { return out << test.name; }

class WakeupPreemption : public testing::TestWithParam<WakeupCase> {};

TEST_P(WakeupPreemption, IsForThoseThatHaveHadLessThanTheirShare) {
  const WakeupCase& test = GetParam();
  SimulatedRobot robot;
  robot.AddReady(kOne, test.sleeper);
  if (test.sleeper_ran_ns > 0) robot.Run(test.sleeper_ran_ns);
  robot.Sleep(kOne, {});
  robot.AddReady(kTwo);
  if (test.other_ran_ns > 0) robot.Run(test.other_ran_ns);
  EXPECT_EQ(robot.scheduler.PreemptsOnWakeup(kOne), test.preempts);
  robot.Wake(kOne, robot.Progress(), robot.scheduler.PreemptsOnWakeup(kOne));
  EXPECT_EQ(robot.Next(), test.preempts ? kOne : kTwo);
}

const WakeupCase kWakeups[] = {
    {"NobodyHasRun", kOrdinary, 0, 0, false},
    {"OnlyTheOtherHasRun", kOrdinary, 0, kMilli / 2, true},
    {"BatchNever", kBatch, 0, kMilli / 2, false},
};

INSTANTIATE_TEST_SUITE_P(Of, WakeupPreemption, testing::ValuesIn(kWakeups),
                         testing::PrintToStringParamName());

TEST(RobotScheduler, NothingPreemptsOnWakeupWhereTheWorldStands) {
  SimulatedRobot robot(1, false);
  robot.AddReady(kTwo);
  robot.Add(kOne);
  robot.Run(kMilli / 2);
  EXPECT_FALSE(robot.scheduler.PreemptsOnWakeup(kOne));
}

TEST(RobotScheduler, WhoPreemptsHasATurnOfItsOwn) {
  SimulatedRobot robot;
  robot.AddReady(kTwo);
  robot.Add(kOne);
  robot.Run(kMilli / 2);
  robot.Wake(kOne, robot.Progress(), true);
  robot.Run(kMilli);
  EXPECT_EQ(robot.Next(), kTwo) << "with what was left of its turn";
  EXPECT_EQ(robot.Horizon(), robot.Progress() + kMilli / 2);
}

// Where nobody wanted the core meanwhile; a thread of the same robot has woken the other one.
TEST(RobotScheduler, WhoHasUsedItsTurnUpLetsTheNextToWakeGoFirst) {
  for (const std::int64_t ran : {kMilli - 1, kMilli, 100 * kMilli + kMilli / 2}) {
    SimulatedRobot robot;
    robot.AddReady(kOne);
    robot.Add(kTwo);
    robot.Sleep(kTwo, {.for_thread = true});
    robot.Run(ran);
    EXPECT_EQ(robot.Next(), kOne);
    robot.Wake(kTwo, robot.Progress(), false);
    robot.scheduler.EndTurn(0);
    robot.scheduler.Assign(RobotTime(kNever));
    EXPECT_EQ(robot.Next(), ran < kMilli ? kOne : kTwo) << ran;
    EXPECT_EQ(robot.Horizon() - robot.Progress(), ran < kMilli ? 1 : kMilli) << ran;
  }
}

TEST(RobotScheduler, EqualsShareACoreEqually) {
  SimulatedRobot robot;
  std::map<int, std::int64_t> had;
  for (const int thread : {kOne, kTwo, kThree}) robot.AddReady(thread);
  for (int turn = 0; turn < 300; ++turn) {
    const int thread = robot.Next();
    const std::int64_t ns = robot.Horizon() - robot.Progress();
    had[thread] += ns;
    robot.Run(ns);
  }
  for (const int thread : {kOne, kTwo, kThree}) EXPECT_EQ(had[thread], 100 * kMilli);
}

// One that sleeps most of the time goes first whenever it wakes; one that would like more than its
// half does not get it by sleeping for an instant now and then.
TEST(RobotScheduler, SleepingForAnInstantBuysNoMoreThanAShare) {
  SimulatedRobot robot;
  robot.AddReady(kOne);
  robot.AddReady(kTwo);
  std::map<int, std::int64_t> had;
  for (int turn = 0; turn < 2000; ++turn) {
    const int thread = robot.Next();
    const std::int64_t ns = std::min(robot.Horizon() - robot.Progress(), 100 * kMicro);
    had[thread] += ns;
    robot.Run(ns);
    if (thread != kOne) continue;
    const bool first = robot.scheduler.PreemptsOnWakeup(kOne);
    robot.Sleep(kOne, {});
    robot.Wake(kOne, robot.Progress(), first);
  }
  EXPECT_LE(had[kOne], had[kTwo] + 2 * kMilli);
}

TEST(RobotScheduler, ASleepBeginsAnotherTurn) {
  SimulatedRobot robot;
  robot.AddReady(kOne);
  robot.AddReady(kTwo);
  robot.scheduler.Dispatch(0, kOne);
  robot.scheduler.SleptSince(kOne, VirtualNs(kMilli));
  robot.ComeTo(0, kMilli);
  robot.scheduler.Stop(0, VirtualNs(kMilli), VirtualNs(kMilli));
  robot.scheduler.EndTurn(0);
  robot.scheduler.Assign(RobotTime(kNever));
  EXPECT_EQ(robot.Next(), kOne);
  EXPECT_EQ(robot.Horizon(), 2 * kMilli);
}

// Effective priorities: thread 1 is blocked on 2, and 2 on 3.
struct InheritanceCase {
  const char* name;
  SchedulingParameters one, two, three;
  int runs;  // of those that are not blocked: 3, and a fourth of SCHED_FIFO 55
};

std::ostream& operator<<(std::ostream& out, const InheritanceCase& test) {
  return out << test.name;
}

class PriorityInheritance : public testing::TestWithParam<InheritanceCase> {};

TEST_P(PriorityInheritance, ReachesTheEndOfTheChain) {
  constexpr int kFourth = 4;
  const InheritanceCase& test = GetParam();
  SimulatedRobot robot;
  robot.AddReady(kThree, test.three);
  robot.AddReady(kFourth, {.policy = SCHED_FIFO, .priority = 55});
  robot.Add(kTwo, test.two);
  robot.Add(kOne, test.one);
  robot.Sleep(kTwo, {});
  robot.scheduler.SetBlockedOn(kTwo, kThree);
  robot.scheduler.FindEffectivePriority(kThree);
  robot.Sleep(kOne, {});
  robot.scheduler.SetBlockedOn(kOne, kTwo);
  robot.scheduler.FindEffectivePriority(kTwo);
  robot.scheduler.Assign(RobotTime(kNever));
  EXPECT_EQ(robot.Next(), test.runs);
  robot.scheduler.SetBlockedOn(kTwo, kNobody);
  robot.scheduler.FindEffectivePriority(kThree);
  robot.scheduler.Assign(RobotTime(kNever));
  EXPECT_EQ(robot.Next(), test.three.priority > 55 ? kThree : kFourth) << "it lost what it got";
}

const InheritanceCase kInheritances[] = {
    {"NobodyUrgentWaits", kOrdinary, kOrdinary, kOrdinary, 4},
    {"TheNextInTheChainIsUrgent", kOrdinary, kFifo60, kOrdinary, kThree},
    {"TheLastInTheChainIsUrgent", kFifo60, kOrdinary, kOrdinary, kThree},
    {"TheyAreNotUrgentEnough", kFifo50, kFifo50, kOrdinary, 4},
    {"TheOwnerIsMoreUrgentThanAll", kFifo50, kOrdinary, kFifo60, kThree},
};

INSTANTIATE_TEST_SUITE_P(Where, PriorityInheritance, testing::ValuesIn(kInheritances),
                         testing::PrintToStringParamName());

TEST(RobotScheduler, ACircleOfBlockedThreadsEnds) {
  SimulatedRobot robot;
  robot.Add(kOne, kFifo50);
  robot.Add(kTwo);
  robot.scheduler.SetBlockedOn(kOne, kTwo);
  robot.scheduler.SetBlockedOn(kTwo, kOne);
  EXPECT_TRUE(robot.scheduler.FindEffectivePriority(kTwo));
  EXPECT_EQ(robot.scheduler.PriorityOf(kTwo), robot.scheduler.PriorityOf(kOne));
}

TEST(RobotScheduler, AnOwnerThatHasEndedInheritsNothing) {
  SimulatedRobot robot;
  robot.Add(kOne, kFifo50);
  robot.Add(kTwo);
  robot.scheduler.SetBlockedOn(kOne, kTwo);
  robot.scheduler.Remove(kTwo);
  EXPECT_EQ(robot.scheduler.BlockedOn(kOne), kNobody);
  EXPECT_FALSE(robot.scheduler.FindEffectivePriority(kTwo));
}

TEST(RobotScheduler, AChildHasItsCreatorsParametersUnlessTheyAreReset) {
  SimulatedRobot robot(2);
  robot.Add(kOne, kFifo50);
  robot.Add(kTwo);
  ASSERT_TRUE(robot.scheduler.SetCores(kOne, 2));
  robot.scheduler.Inherit(kTwo, kOne);
  EXPECT_EQ(robot.scheduler.ParametersOf(kTwo).policy, SCHED_FIFO);
  EXPECT_EQ(robot.scheduler.CoresOf(kTwo), 2u);
  robot.scheduler.SetParameters(kOne,
                                {.policy = SCHED_FIFO, .priority = 50, .resets_on_fork = true}, {});
  robot.Add(kThree);
  robot.scheduler.Inherit(kThree, kOne);
  EXPECT_EQ(robot.scheduler.ParametersOf(kThree).policy, SCHED_OTHER);
  EXPECT_FALSE(robot.scheduler.ParametersOf(kThree).resets_on_fork);
}

TEST(RobotScheduler, AReadyThreadLeavesACoreThatItIsNotAllowedOnAnyMore) {
  SimulatedRobot robot(2);
  robot.AddReady(kOne);
  EXPECT_EQ(robot.Next(0), kOne);
  EXPECT_FALSE(robot.scheduler.SetCores(kOne, 4)) << "the robot has no such core";
  ASSERT_TRUE(robot.scheduler.SetCores(kOne, 2));
  robot.scheduler.Assign(RobotTime(kNever));
  EXPECT_EQ(robot.Next(0), kNobody);
  EXPECT_EQ(robot.Next(1), kOne);
}

TEST(RobotScheduler, TheLeastAdvancedIdleCoreActsWhenAWaitIsOver) {
  SimulatedRobot robot(2);
  robot.Add(kOne);
  robot.ComeTo(0, 300);
  robot.ComeTo(1, 200);
  robot.Sleep(kOne, {.until = RobotTime(700)});
  EXPECT_EQ(robot.scheduler.NextActionOf(0).ns(), kNever);
  EXPECT_EQ(robot.scheduler.NextActionOf(1).ns(), 700);
  robot.scheduler.Assign(RobotTime(500));
  EXPECT_EQ(robot.scheduler.NextActionOf(1).ns(), 500) << "the robot's own";
  robot.ComeTo(1, 800);
  EXPECT_EQ(robot.scheduler.NextActionOf(0).ns(), 700);
}

TEST(RobotScheduler, AWaitThatIsOverAsItBeginsEndsThenOnACoreThatIsBehindToo) {
  SimulatedRobot robot(2);
  robot.Add(kOne);
  robot.ComeTo(0, 300);
  robot.ComeTo(1, 2000);
  robot.Sleep(kOne, {.until = RobotTime(500), .from = RobotTime(2000)});
  EXPECT_EQ(robot.scheduler.NextActionOf(0).ns(), 2000);
  EXPECT_EQ(robot.scheduler.NextActionOf(1).ns(), kNever);
  EXPECT_FALSE(robot.scheduler.IsAnythingDue(RobotTime(1999)));
  EXPECT_TRUE(robot.scheduler.IsAnythingDue(RobotTime(2000)));
}

TEST(RobotScheduler, ACoreThatActsNowNeedsNoOther) {
  SimulatedRobot robot;
  robot.AddReady(kOne);
  robot.Add(kTwo);
  robot.Sleep(kTwo, {.until = RobotTime(700)});
  EXPECT_EQ(robot.scheduler.NextActionOf(0).ns(), 0);
}

TEST(RobotScheduler, AWokenThreadIsAsLateAsTheCoreThatItTakes) {
  SimulatedRobot robot;
  robot.AddReady(kTwo);
  robot.Add(kOne, kFifo50);
  robot.Sleep(kOne, {});
  robot.ComeTo(0, 900);
  EXPECT_EQ(robot.scheduler.LatenessOf(kOne, RobotTime(700), RobotTime(0), false).ns(), 200);
  EXPECT_EQ(robot.scheduler.LatenessOf(kOne, RobotTime(1000), RobotTime(0), false).ns(), 0);
  EXPECT_EQ(robot.scheduler.LatenessOf(kOne, RobotTime(700), RobotTime(950), false).ns(), 250);
}

TEST(RobotScheduler, WhoWaitsForItsTurnIsNotLate) {
  SimulatedRobot robot;
  robot.AddReady(kTwo);
  robot.Add(kOne);
  robot.Sleep(kOne, {});
  robot.ComeTo(0, 900);
  EXPECT_EQ(robot.scheduler.LatenessOf(kOne, RobotTime(700), RobotTime(0), false).ns(), 0);
}

TEST(RobotScheduler, ThreadNumbersAreUsedAgain) {
  SimulatedRobot robot;
  for (const int thread : {kOne, kTwo, kThree}) robot.AddReady(thread);
  robot.scheduler.Remove(kOne);
  robot.scheduler.Assign(RobotTime(kNever));
  EXPECT_EQ(robot.Next(), kTwo);
  robot.Add(kOne, kFifo60);
  robot.scheduler.Enqueue(kOne, RobotTime(0), false);
  robot.scheduler.Assign(RobotTime(kNever));
  EXPECT_EQ(robot.Next(), kOne);
  EXPECT_EQ(robot.scheduler.ParametersOf(kThree).policy, SCHED_OTHER);
}

TEST(RobotScheduler, AsksWhatAThreadWaitsForOnlyWhenThatHasChanged) {
  SimulatedRobot robot;
  robot.AddReady(0);
  for (int thread = 1; thread <= 100; ++thread) {
    robot.Add(thread);
    robot.Sleep(thread, {.until = RobotTime(10 * kMilli)});
  }
  const int before = robot.asked;
  robot.Run(100 * kMicro);
  EXPECT_EQ(robot.Horizon(), 10 * kMilli);
  EXPECT_LE(robot.asked - before, 2);  // the one that has run, as often as it was enqueued
}

TEST(RobotScheduler, WhereTheWorldStandsItAsksEachTime) {
  SimulatedRobot robot(1, false);
  robot.Add(0);
  robot.Sleep(0, {.until = RobotTime(10 * kMilli)});
  robot.waits[0].is_over = true;
  robot.scheduler.Assign(RobotTime(kNever));
  EXPECT_EQ(robot.scheduler.NextActionOf(0).ns(), 0);
}

TEST(RobotScheduler, TheNextActionIsTheFirstEndOfAWaitOrOfATimer) {
  SimulatedRobot robot;
  for (const int thread : {0, 1, 2}) robot.Add(thread);
  robot.Sleep(0, {.until = RobotTime(5 * kMilli)});
  robot.Sleep(1, {.until = RobotTime(3 * kMilli)});
  robot.Sleep(2, {.until = RobotTime(9 * kMilli)});
  EXPECT_EQ(robot.scheduler.NextActionOf(0).ns(), 3 * kMilli);
  EXPECT_FALSE(robot.scheduler.IsAnythingDue(RobotTime(3 * kMilli - 1)));
  EXPECT_TRUE(robot.scheduler.IsAnythingDue(RobotTime(3 * kMilli)));
  robot.SetExpiry(2, 2 * kMilli);
  EXPECT_EQ(robot.scheduler.NextActionOf(0).ns(), 2 * kMilli);
  robot.SetExpiry(2, kNever);
  EXPECT_EQ(robot.scheduler.NextActionOf(0).ns(), 3 * kMilli);
  // Later than before: the first is another one's.
  robot.Sleep(1, {.until = RobotTime(8 * kMilli)});
  EXPECT_EQ(robot.scheduler.NextActionOf(0).ns(), 5 * kMilli);
  robot.scheduler.Remove(0);
  robot.scheduler.Assign(RobotTime(kNever));
  EXPECT_EQ(robot.scheduler.NextActionOf(0).ns(), 8 * kMilli);
  EXPECT_FALSE(robot.scheduler.IsAnythingDue(RobotTime(5 * kMilli)));
  robot.scheduler.Dequeue(0);  // it has ended already
}

TEST(RobotScheduler, AWaitWhoseDeadlineHasChangedCountsOnceThatIsSaid) {
  SimulatedRobot robot;
  robot.Add(0);
  robot.Sleep(0, {.until = RobotTime(5 * kMilli)});
  robot.waits[0].until = RobotTime(kMilli);
  robot.scheduler.WaitChanged(0);
  EXPECT_TRUE(robot.scheduler.IsAnythingDue(RobotTime(0)));  // nobody knows before the next Assign
  robot.scheduler.Assign(RobotTime(kNever));
  EXPECT_EQ(robot.scheduler.NextActionOf(0).ns(), kMilli);
}

TEST(RobotSchedulerDeathTest, AThreadThatWasNotAddedIsABug) {
  SimulatedRobot robot;
  EXPECT_DEATH(robot.scheduler.Enqueue(kOne, RobotTime(0), false), "a bug in tcs");
}

}  // namespace
}  // namespace tcs
