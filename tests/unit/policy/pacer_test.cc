#include "coordinator/policy/pacer.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr HostTime kStart = HostTime::FromNanoseconds(5'000'000'000);
constexpr HostDuration kHeadStart = Pacer::kHeadStart;

TEST(PacerTest, WithoutAPaceNobodyWaits) {
  Pacer pacer(0, false);
  EXPECT_EQ(pacer.ToWait(RobotTime(0), kStart), HostDuration());
  EXPECT_EQ(pacer.ToWait(RobotTime(900 * kMs), kStart), HostDuration());
  EXPECT_EQ(pacer.now(), RobotTime(900 * kMs));
  EXPECT_EQ(pacer.behind(), HostDuration());
}

// A pacer whose run has acted at 0 at kStart, and waits since: it is at 0 when the wall clock is at
// kStart + kHeadStart, its 0.
Pacer Loaded(double pace) {
  Pacer pacer(pace, false);
  pacer.ToWait(RobotTime(0), kStart);
  pacer.ToWait(RobotTime(1000 * kMs), kStart);
  return pacer;
}

HostTime Wall(std::int64_t since_zero_ns) { return kStart + kHeadStart + HostNs(since_zero_ns); }

TEST(PacerTest, AtPaceOneAnActWaitsForItsTimeOnTheWall) {
  Pacer pacer = Loaded(1);
  EXPECT_EQ(pacer.ToWait(RobotTime(10 * kMs), Wall(0)), HostNs(10 * kMs) - kHeadStart);
  EXPECT_EQ(pacer.ToWait(RobotTime(10 * kMs), Wall(4 * kMs)), HostNs(6 * kMs) - kHeadStart);
  EXPECT_EQ(pacer.now(), RobotTime(4 * kMs));  // which passes while it waits
  EXPECT_EQ(pacer.ToWait(RobotTime(10 * kMs), Wall(10 * kMs) - kHeadStart), HostDuration());
  EXPECT_EQ(pacer.now(), RobotTime(10 * kMs));
  EXPECT_EQ(pacer.behind(), HostDuration());
}

TEST(PacerTest, ItActsBeforeTheWallClockByTheHeadStartAndNoMore) {
  Pacer pacer = Loaded(1);
  for (std::int64_t at = 1 * kMs; at <= 20 * kMs; at += 1 * kMs) {
    EXPECT_EQ(pacer.ToWait(RobotTime(at), Wall(at) - kHeadStart - HostNs(1)), HostNs(1)) << at;
    EXPECT_EQ(pacer.ToWait(RobotTime(at), Wall(at) - kHeadStart), HostDuration()) << at;
  }
  // Its time does not go back while the wall clock comes after it.
  pacer.ToWait(RobotTime(40 * kMs), Wall(19 * kMs));
  EXPECT_EQ(pacer.now(), RobotTime(20 * kMs));
}

TEST(PacerTest, AnActThatTakesNoLongerThanTheHeadStartMakesNothingLate) {
  Pacer pacer = Loaded(1);
  pacer.ToWait(RobotTime(10 * kMs), Wall(10 * kMs) - kHeadStart);  // takes the head start
  EXPECT_EQ(pacer.ToWait(RobotTime(10 * kMs), Wall(10 * kMs)), HostDuration());
  EXPECT_EQ(pacer.account().most, HostDuration());
  EXPECT_EQ(pacer.ToWait(RobotTime(10 * kMs), Wall(10 * kMs + 1)), HostDuration());
  EXPECT_EQ(pacer.account().most, HostNs(1));
}

TEST(PacerTest, AtPaceTwoItWaitsHalfAsLongAndAtAQuarterFourTimes) {
  Pacer twice = Loaded(2), quarter = Loaded(0.25);
  EXPECT_EQ(twice.ToWait(RobotTime(10 * kMs), Wall(0)), HostNs(5 * kMs) - kHeadStart);
  EXPECT_EQ(quarter.ToWait(RobotTime(10 * kMs), Wall(0)), HostNs(40 * kMs) - kHeadStart);
}

TEST(PacerTest, TheWallClockCountsFromWhenProgramsHaveLoaded) {
  Pacer pacer(1, false);
  pacer.ToWait(RobotTime(0), kStart);
  EXPECT_EQ(pacer.ToWait(RobotTime(0), kStart + HostNs(7 * kMs)), HostDuration());
  EXPECT_EQ(pacer.ToWait(RobotTime(10 * kMs), kStart + HostNs(7 * kMs)), HostNs(10 * kMs));
  EXPECT_EQ(pacer.account().most, HostDuration());
  // Once it has waited it is late where it is late.
  EXPECT_EQ(pacer.ToWait(RobotTime(10 * kMs), Wall(24 * kMs)), HostDuration());
  EXPECT_EQ(pacer.account().most, HostNs(7 * kMs));
}

TEST(PacerTest, ARunThatNeverWaitsIsBehindAllTheSame) {
  Pacer pacer(1, false);
  const HostDuration most = Pacer::kMostMadeUp;
  pacer.ToWait(RobotTime(0), kStart);
  EXPECT_EQ(pacer.ToWait(RobotTime(1 * kMs), kStart + most), HostDuration());
  EXPECT_EQ(pacer.behind(), HostDuration());
  EXPECT_EQ(pacer.ToWait(RobotTime(2 * kMs), Wall(30 * kMs) + most), HostDuration());
  EXPECT_EQ(pacer.behind(), HostNs(29 * kMs));
}

TEST(PacerTest, ProgramsLoadOnceTheRunThatStartsStandingMayGoOn) {
  Pacer pacer(1, true);
  pacer.ToWait(RobotTime(0), kStart);
  const HostTime goes_on = kStart + HostNs(700 * kMs);
  pacer.GoOn(goes_on);
  EXPECT_EQ(pacer.ToWait(RobotTime(0), goes_on + HostNs(7 * kMs)), HostDuration());
  EXPECT_EQ(pacer.ToWait(RobotTime(10 * kMs), goes_on + HostNs(7 * kMs)), HostNs(10 * kMs));
  EXPECT_EQ(pacer.account().most, HostDuration());
}

TEST(PacerTest, WhatItIsBehindByItMakesUpFor) {
  Pacer pacer = Loaded(1);
  EXPECT_EQ(pacer.ToWait(RobotTime(10 * kMs), Wall(60 * kMs)), HostDuration());
  EXPECT_EQ(pacer.behind(), HostNs(50 * kMs));
  EXPECT_EQ(pacer.ToWait(RobotTime(62 * kMs), Wall(65 * kMs)), HostDuration());
  EXPECT_EQ(pacer.behind(), HostNs(3 * kMs));
  EXPECT_EQ(pacer.ToWait(RobotTime(70 * kMs), Wall(66 * kMs)), HostNs(4 * kMs) - kHeadStart);
  EXPECT_EQ(pacer.account().behind, HostNs(5 * kMs));  // between the two asks, and not after
  EXPECT_EQ(pacer.account().most, HostNs(50 * kMs));
  EXPECT_EQ(pacer.account().given_up, HostDuration());
}

TEST(PacerTest, WhatIsMoreThanItMakesUpForIsGivenUp) {
  Pacer pacer = Loaded(1);
  EXPECT_EQ(pacer.ToWait(RobotTime(10 * kMs), Wall(2010 * kMs)), HostDuration());
  EXPECT_EQ(pacer.behind(), Pacer::kMostMadeUp);
  EXPECT_EQ(pacer.account().given_up, HostNs(2000 * kMs) - Pacer::kMostMadeUp);
  EXPECT_EQ(pacer.ToWait(RobotTime(210 * kMs), Wall(2010 * kMs)), HostNs(100 * kMs) - kHeadStart);
}

TEST(PacerTest, ARunThatStartsStandingHasNotDoneEvenWhatHappensAtZero) {
  Pacer pacer(1, true);
  EXPECT_EQ(pacer.ToWait(RobotTime(0), kStart), Pacer::kForEver);
  EXPECT_TRUE(pacer.stands());
  EXPECT_EQ(pacer.now(), RobotTime(0));
  pacer.GoOn(kStart + HostNs(700 * kMs));
  EXPECT_EQ(pacer.ToWait(RobotTime(0), kStart + HostNs(700 * kMs)), HostDuration());
  EXPECT_EQ(pacer.ToWait(RobotTime(10 * kMs), kStart + HostNs(700 * kMs)), HostNs(10 * kMs));
  EXPECT_EQ(pacer.account().stood, HostNs(700 * kMs));
  EXPECT_EQ(pacer.account().behind, HostDuration());
}

TEST(PacerTest, AStepIsExactHoweverFarApartTheActsAre) {
  Pacer pacer(0, true);
  pacer.ToWait(RobotTime(0), kStart);
  pacer.StepBy(VirtualNs(100 * kMs), kStart);
  for (std::int64_t next = 0; next <= 100 * kMs; next += 20 * kMs) {
    EXPECT_EQ(pacer.ToWait(RobotTime(next), kStart), HostDuration()) << next;
  }
  EXPECT_EQ(pacer.ToWait(RobotTime(120 * kMs), kStart), Pacer::kForEver);
  EXPECT_EQ(pacer.now(), RobotTime(100 * kMs));
  pacer.StepBy(VirtualNs(7 * kMs), kStart);
  EXPECT_EQ(pacer.ToWait(RobotTime(120 * kMs), kStart), Pacer::kForEver);
  EXPECT_EQ(pacer.now(), RobotTime(107 * kMs));
  pacer.StepBy(VirtualNs(13 * kMs), kStart);
  EXPECT_EQ(pacer.ToWait(RobotTime(120 * kMs), kStart), HostDuration());
  EXPECT_EQ(pacer.ToWait(RobotTime(120 * kMs + 1), kStart), Pacer::kForEver);
  EXPECT_EQ(pacer.now(), RobotTime(120 * kMs));
}

TEST(PacerTest, OfStepsThatAreAskedForAtOnceEachCounts) {
  Pacer pacer(0, true);
  pacer.ToWait(RobotTime(0), kStart);
  pacer.StepBy(VirtualNs(10 * kMs), kStart);
  pacer.StepBy(VirtualNs(10 * kMs), kStart);
  EXPECT_EQ(pacer.ToWait(RobotTime(20 * kMs), kStart), HostDuration());
  EXPECT_EQ(pacer.ToWait(RobotTime(21 * kMs), kStart), Pacer::kForEver);
}

TEST(PacerTest, AStepHasThePaceOfTheRun) {
  Pacer pacer(0.5, true);
  pacer.ToWait(RobotTime(0), kStart);
  pacer.StepBy(VirtualNs(10 * kMs), kStart + HostNs(3 * kMs));
  EXPECT_EQ(pacer.ToWait(RobotTime(0), kStart + HostNs(3 * kMs)), HostDuration());
  // Nothing is due before the step's end, which is waited for all the same.
  EXPECT_EQ(pacer.ToWait(RobotTime(50 * kMs), kStart + HostNs(3 * kMs)), HostNs(20 * kMs));
  EXPECT_FALSE(pacer.stands());
  EXPECT_EQ(pacer.ToWait(RobotTime(50 * kMs), kStart + HostNs(23 * kMs)), Pacer::kForEver);
  EXPECT_EQ(pacer.now(), RobotTime(10 * kMs));
}

TEST(PacerTest, ARunStandsWhereItHasCometo) {
  Pacer pacer = Loaded(1);
  EXPECT_EQ(pacer.ToWait(RobotTime(50 * kMs), Wall(30 * kMs)), HostNs(20 * kMs) - kHeadStart);
  pacer.Stand(Wall(31 * kMs));
  EXPECT_EQ(pacer.ToWait(RobotTime(50 * kMs), Wall(31 * kMs)), Pacer::kForEver);
  EXPECT_EQ(pacer.now(), RobotTime(30 * kMs));
  // What still happens at that time does.
  EXPECT_EQ(pacer.ToWait(RobotTime(30 * kMs), Wall(40 * kMs)), HostDuration());
  pacer.ToWait(RobotTime(50 * kMs), Wall(41 * kMs));
  pacer.GoOn(Wall(1041 * kMs));
  EXPECT_EQ(pacer.ToWait(RobotTime(50 * kMs), Wall(1041 * kMs)), HostNs(20 * kMs) - kHeadStart);
  EXPECT_EQ(pacer.account().given_up, HostDuration());
}

TEST(PacerTest, AnotherPaceCountsFromNow) {
  Pacer pacer(1, false);
  pacer.ToWait(RobotTime(0), kStart);
  pacer.ToWait(RobotTime(100 * kMs), kStart + HostNs(100 * kMs));
  pacer.SetPace(0.1, kStart + HostNs(100 * kMs));
  EXPECT_EQ(pacer.ToWait(RobotTime(110 * kMs), kStart + HostNs(100 * kMs)),
            HostNs(100 * kMs) - kHeadStart);
  pacer.SetPace(0, kStart + HostNs(101 * kMs));
  EXPECT_EQ(pacer.ToWait(RobotTime(900 * kMs), kStart + HostNs(101 * kMs)), HostDuration());
}

TEST(PacerTest, StandingDoesNotUndoWhatAStepHasLeft) {
  Pacer pacer(1, true);
  pacer.ToWait(RobotTime(0), kStart);
  pacer.StepBy(VirtualNs(100 * kMs), kStart);
  pacer.ToWait(RobotTime(0), kStart);
  pacer.ToWait(RobotTime(90 * kMs), Wall(40 * kMs));
  pacer.Stand(Wall(40 * kMs));  // in the middle of the step
  EXPECT_EQ(pacer.ToWait(RobotTime(90 * kMs), Wall(41 * kMs)), Pacer::kForEver);
  EXPECT_EQ(pacer.now(), RobotTime(40 * kMs));
}

}  // namespace
}  // namespace tcs
