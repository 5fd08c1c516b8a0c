// How far a thread may run because of one other thread of its robot: a table, one case a line.
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <random>

#include "tests/unit/policy/simulated_robot.h"

namespace tcs {
namespace {

constexpr int kRunning = 0, kOther = 1;
using Wait = RobotScheduler::Wait;
using Outlook = RobotScheduler::Outlook;

// The running thread has come to 10 ms, and has had 0.3 ms of its turn.
constexpr std::int64_t kNow = 10 * kMilli, kHad = 300 * kMicro;
constexpr std::int64_t kTurnEnd = kNow + kMilli - kHad, kGrain = 100 * kMicro;
constexpr std::int64_t kSoon = kNow + 50 * kMicro, kLater = kNow + 5 * kMilli;
constexpr Outlook kNothing{};
constexpr Outlook kMeasuredInput{.input = RobotTime(kSoon), .outside_input = RobotTime(kSoon)};
constexpr Outlook kFixedInput{
    .input = RobotTime(kSoon), .outside_input = RobotTime(kSoon), .acts_at_once = true};
constexpr Outlook kInputNow{
    .input = RobotTime(kNow), .outside_input = RobotTime(kNow), .acts_at_once = true};
constexpr Outlook kGivenWay{.input = RobotTime(kNow),
                            .outside_input = RobotTime(kNow),
                            .acts_at_once = true,
                            .has_given_way = true};
constexpr Outlook kOwnRobotsInput{.input = RobotTime(kSoon), .acts_at_once = true};
constexpr Outlook kSensor{.output = RobotTime(kSoon)};

struct HorizonCase {
  const char* name;
  SchedulingParameters running, other;
  Wait wait;
  Outlook outlook;
  std::int64_t horizon_ns;
};

std::ostream& operator<<(std::ostream& out, const HorizonCase& test) { return out << test.name; }

class Horizon : public testing::TestWithParam<HorizonCase> {};

TEST_P(Horizon, IsTheFirstInstantAtWhichTheOtherCouldTakeTheCore) {
  const HorizonCase& test = GetParam();
  SimulatedRobot robot;
  robot.ComeTo(0, kNow - kHad);
  robot.Add(kOther, test.other);
  robot.Sleep(kOther, {});
  robot.AddReady(kRunning, test.running);
  robot.Run(kHad);
  robot.Sleep(kOther, test.wait);
  ASSERT_EQ(robot.Next(), kRunning);
  EXPECT_EQ(robot.Horizon(test.outlook), test.horizon_ns);
}

constexpr Wait kSleepsShort{.until = RobotTime(kSoon)}, kSleepsLong{.until = RobotTime(kLater)},
    kForever{.until = RobotTime(kNever)}, kTimer{.next_expiry = RobotTime(kSoon)},
    kReads{.for_input = true}, kFutex{.for_thread = true};

const HorizonCase kHorizonCases[] = {
    // Somebody who is more urgent.
    {"UrgentSleeperWakes", kOrdinary, kFifo50, kSleepsShort, kNothing, kSoon},
    {"UrgentTimerExpires", kOrdinary, kFifo50, kTimer, kNothing, kSoon},
    {"UrgentSleeperBeforeFifo", kFifo50, kFifo60, kSleepsShort, kNothing, kSoon},
    {"UrgentReaderOfASensor", kOrdinary, kFifo50, kReads, kSensor, kSoon},
    {"UrgentReaderMeasured", kOrdinary, kFifo50, kReads, kMeasuredInput, kSoon + kGrain},
    {"UrgentReaderFixed", kOrdinary, kFifo50, kReads, kFixedInput, kSoon},
    {"UrgentReaderAtThisInstant", kOrdinary, kFifo50, kReads, kInputNow, kNow},
    {"UrgentReaderOnceWayWasGiven", kOrdinary, kFifo50, kReads, kGivenWay, kNow + kGrain},
    {"UrgentReaderOfItsOwnRobot", kOrdinary, kFifo50, kReads, kOwnRobotsInput, kSoon},
    {"UrgentInAFutexOnOneCore", kOrdinary, kFifo50, kFutex, kFixedInput, kNever},
    // Somebody who is less urgent.
    {"LessUrgentSleeper", kFifo50, kOrdinary, kSleepsShort, kNothing, kNever},
    {"LessUrgentReader", kFifo50, kOrdinary, kReads, kFixedInput, kNever},
    {"LessUrgentTimer", kFifo60, kFifo50, kTimer, kNothing, kNever},
    {"IdleSleeper", kOrdinary, kIdle, kSleepsShort, kNothing, kNever},
    // Equals: with less than its share it preempts on wake-up, else it has the next turn.
    {"EqualSleeperPreempts", kOrdinary, kOrdinary, kSleepsShort, kNothing, kSoon},
    {"EqualSleepsBeyondTheTurn", kOrdinary, kOrdinary, kSleepsLong, kNothing, kLater},
    {"EqualThatSleepsForEver", kOrdinary, kOrdinary, kForever, kNothing, kNever},
    {"BatchHasTheNextTurn", kOrdinary, kBatch, kSleepsShort, kNothing, kTurnEnd},
    {"BatchIsPreempted", kBatch, kOrdinary, kSleepsShort, kNothing, kSoon},
    {"EqualReaderFixed", kOrdinary, kOrdinary, kReads, kFixedInput, kSoon},
    {"EqualReaderMeasured", kOrdinary, kOrdinary, kReads, kMeasuredInput, kSoon + kGrain},
    {"EqualReaderOfASensor", kOrdinary, kOrdinary, kReads, kSensor, kSoon},
    {"EqualReaderOfItsOwnRobot", kOrdinary, kOrdinary, kReads, kOwnRobotsInput, kNever},
    {"EqualBatchReader", kOrdinary, kBatch, kReads, kFixedInput, kNever},
    // Quanta.
    {"FifoHasNoTurnEnd", kFifo50, kFifo50, kSleepsShort, kNothing, kNever},
    {"FifoKeepsRoundRobinWaiting", kFifo50, kRoundRobin, kSleepsShort, kNothing, kNever},
    {"RoundRobinTurn", kRoundRobin, kRoundRobin, kSleepsShort, kNothing,
     kNow + 100 * kMilli - kHad},
};

INSTANTIATE_TEST_SUITE_P(BecauseOf, Horizon, testing::ValuesIn(kHorizonCases),
                         testing::PrintToStringParamName());

TEST(HorizonOf, IsNeverBeyondItsLimit) {
  SimulatedRobot robot;
  robot.AddReady(kRunning);
  EXPECT_EQ(robot.Horizon({}, 0, 7 * kMilli), 7 * kMilli);
}

TEST(HorizonOf, AReadyEqualEndsTheTurn) {
  SimulatedRobot robot;
  robot.AddReady(kRunning);
  robot.AddReady(kOther);
  EXPECT_EQ(robot.Horizon(), kMilli);
}

TEST(HorizonOf, ItsOwnProcessesTimerIsLookedAtInTime) {
  SimulatedRobot robot;
  robot.AddReady(kRunning);
  robot.SetExpiry(kRunning, kSoon);
  EXPECT_EQ(robot.Horizon(), kSoon);
}

TEST(HorizonOf, AnUrgentThreadThatIsReadyLaterTakesTheCoreThen) {
  SimulatedRobot robot;
  robot.AddReady(kRunning);
  robot.Add(kOther, kFifo50);
  robot.Wake(kOther, 3 * kMilli, false);
  EXPECT_EQ(robot.Next(), kRunning);
  EXPECT_EQ(robot.Horizon(), 3 * kMilli);
}

TEST(HorizonOf, OnSeveralCoresTheOthersMayWakeAnUrgentThread) {
  SimulatedRobot robot(2);
  robot.AddReady(kRunning);
  robot.Add(kOther, kFifo50);
  robot.Sleep(kOther, kFutex);
  EXPECT_EQ(robot.Horizon({.input = RobotTime(kSoon), .acts_at_once = true}), kSoon);
}

TEST(HorizonOf, ASleeperMayNotTakeACoreThatItIsNotAllowedOn) {
  SimulatedRobot robot(2);
  robot.AddReady(kRunning);
  robot.AddReady(2);
  robot.Add(kOther);
  ASSERT_TRUE(robot.scheduler.SetCores(kOther, 2));
  robot.Run(300 * kMicro, 0);
  robot.Run(300 * kMicro, 1);
  robot.Sleep(kOther, {.until = RobotTime(900 * kMicro)});
  EXPECT_EQ(robot.Horizon({}, 0), kNever);
  EXPECT_EQ(robot.Horizon({}, 1), 900 * kMicro);
}

TEST(HorizonOf, OfSeveralCoresTheOneThatIsThereLastMakesRoom) {
  SimulatedRobot robot(2);
  robot.AddReady(kRunning);
  robot.AddReady(2);
  robot.Add(kOther);
  robot.Run(100 * kMicro, 0);
  robot.Run(100 * kMicro, 1);
  robot.Sleep(kOther, {.until = RobotTime(200 * kMicro)});
  EXPECT_EQ(robot.Horizon({}, 0), kNever) << "the other core can";
  robot.Run(200 * kMicro, 0);
  EXPECT_EQ(robot.Horizon({}, 1), 200 * kMicro);
}

TEST(HorizonOf, AThreadThatIsAloneMaySleepUntilSomethingHappens) {
  SimulatedRobot robot;
  robot.AddReady(kRunning);
  EXPECT_EQ(robot.scheduler.HorizonOf(0, kRunning, RobotTime(kLater), {}).idle.ns(), kLater);
  robot.Add(kOther, kIdle);
  robot.Sleep(kOther, kSleepsShort);
  EXPECT_EQ(robot.scheduler.HorizonOf(0, kRunning, RobotTime(kLater), {}).run.ns(), kLater);
  EXPECT_EQ(robot.scheduler.HorizonOf(0, kRunning, RobotTime(kLater), {}).idle.ns(), kSoon);
  robot.Wake(kOther, 0, false);
  EXPECT_EQ(robot.scheduler.HorizonOf(0, kRunning, RobotTime(kLater), {}).idle.ns(), 0);
}

TEST(HorizonOf, AThreadThatEndsWhileItRunsHasNoHorizonButItsLimit) {
  SimulatedRobot robot;
  robot.AddReady(kRunning);
  robot.scheduler.Dispatch(0, kRunning);
  robot.scheduler.Remove(kRunning);
  EXPECT_EQ(robot.scheduler.HorizonOf(0, kRunning, RobotTime(kLater), {}).run.ns(), kLater);
  EXPECT_EQ(robot.scheduler.HorizonWhileWorldStands(0, kRunning).ns(), kNever);
  robot.scheduler.Stop(0, VirtualNs(kMilli), VirtualNs(kMilli));
  robot.scheduler.Assign(RobotTime(kNever));
  EXPECT_EQ(robot.Next(), RobotScheduler::kNobody);
}

// Whatever the scheduler need not look at of those that wait for long.
TEST(HorizonOf, AmongManyIsTheLeastOfThoseBesideEachOfThem) {
  std::mt19937 random(1);
  const auto any = [&](int below) {
    return static_cast<int>(random() % static_cast<unsigned>(below));
  };
  const auto some_time = [&] { return any(3) == 0 ? kNever : any(3'000) * kMicro; };
  for (int round = 0; round < 300; ++round) {
    const RobotScheduler::Outlook outlook{.input = RobotTime(some_time()),
                                          .outside_input = RobotTime(kNever),
                                          .output = RobotTime(some_time()),
                                          .acts_at_once = any(2) == 0};
    const std::int64_t limit = some_time();
    SimulatedRobot all;
    all.AddReady(kRunning);
    RobotScheduler::Horizon least{.run = RobotTime(limit), .idle = RobotTime(limit)};
    for (int thread = kRunning + 1; thread <= kRunning + 20; ++thread) {
      const SchedulingParameters parameters = any(3) == 0 ? kFifo50 : SchedulingParameters{};
      const RobotScheduler::Wait wait{.for_input = any(3) == 0,
                                      .for_thread = any(3) == 0,
                                      .until = RobotTime(some_time()),
                                      .next_expiry = RobotTime(some_time())};
      SimulatedRobot alone;
      alone.AddReady(kRunning);
      for (SimulatedRobot* robot : {&all, &alone}) {
        robot->Add(thread, parameters);
        robot->Sleep(thread, wait);
      }
      const auto beside = alone.scheduler.HorizonOf(0, kRunning, RobotTime(limit), outlook);
      least.run = std::min(least.run, beside.run);
      least.idle = std::min(least.idle, beside.idle);
    }
    const auto horizon = all.scheduler.HorizonOf(0, kRunning, RobotTime(limit), outlook);
    EXPECT_EQ(horizon.run, least.run);
    EXPECT_EQ(horizon.idle, least.idle);
  }
}

TEST(HorizonWhileWorldStands, OnlyThreadsOfTheSameProcessBecomeDue) {
  SimulatedRobot robot(1, false);
  robot.AddReady(kRunning);
  robot.Add(kOther, kFifo50);
  robot.Sleep(kOther, {.own_until = RobotTime(kSoon)});
  EXPECT_EQ(robot.scheduler.HorizonWhileWorldStands(0, kRunning).ns(), kNever);
  robot.waits[kOther].process = robot.waits[kRunning].process;
  EXPECT_EQ(robot.scheduler.HorizonWhileWorldStands(0, kRunning).ns(), kSoon);
}

TEST(HorizonWhileWorldStands, AnEqualHasTheNextTurn) {
  SimulatedRobot robot(1, false);
  robot.AddReady(kRunning);
  robot.Add(kOther);
  robot.Sleep(kOther, {.own_until = RobotTime(kSoon)});
  robot.waits[kOther].process = robot.waits[kRunning].process;
  EXPECT_EQ(robot.scheduler.HorizonWhileWorldStands(0, kRunning).ns(), kSoon);
  robot.waits[kOther].own_until = RobotTime(200 * kMicro);
  EXPECT_EQ(robot.scheduler.HorizonWhileWorldStands(0, kRunning).ns(), kMilli);
}

}  // namespace
}  // namespace tcs
