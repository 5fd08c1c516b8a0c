#include "shm/clock_page.h"

#include <gtest/gtest.h>

namespace tcs::shm {
namespace {

constexpr std::uint64_t kOnePerTick = std::uint64_t{1} << 32;

// A page as at the first dispatch: one virtual nanosecond per tick, running since `tsc`.
struct Page : ClockPage {
  explicit Page(std::uint64_t tsc) : ClockPage{} {
    base_time_ns = 1'000;
    base_tsc = tsc;
    ns_per_tick_q32 = kOnePerTick;
    ns_per_host_ns_q32 = kOnePerTick;
    horizon_ns = 5'000;
    executed_adjust = PackAdjust(std::uint64_t{1} << kAdjustBits, 0);
    waited_adjust = PackAdjust(std::uint64_t{1} << kAdjustBits, 0);
  }
};

TEST(ClockPage, TimeIsTheBaseAndWhatWasExecutedSince) {
  const Page page(100);
  const ClockReading r = ReadClockAt(page, 350);
  EXPECT_EQ(r.time_ns, 1'250);
  EXPECT_EQ(r.cpu_ns, 250);
}

TEST(ClockPage, WaitingMovesTheTimeButIsNotCharged) {
  Page page(100);
  page.waited_adjust = PackAdjust(page.waited_adjust, 700);
  const ClockReading r = ReadClockAt(page, 100);
  EXPECT_EQ(r.time_ns, 1'700);
  EXPECT_EQ(r.cpu_ns, 0);
}

TEST(ClockPage, AProcessorHalfAsFastTakesTwiceAsLong) {
  Page page(0);
  page.ns_per_tick_q32 = 2 * kOnePerTick;
  EXPECT_EQ(ReadClockAt(page, 300).cpu_ns, 600);
}

TEST(ClockPage, ShowsNeitherMoreThanTheHorizonNorLessThanBefore) {
  Page page(0);
  EXPECT_EQ(ShownTime(page, ReadClockAt(page, 1'000)), 2'000);
  EXPECT_EQ(ShownTime(page, ReadClockAt(page, 1'000'000)), 5'000);
  page.last_shown_ns = page.last_shown_cpu_ns = 3'000;
  EXPECT_EQ(ShownTime(page, ReadClockAt(page, 1'000)), 3'001);
}

TEST(ClockPage, AClockThatHasNotStartedYetShowsItsBeginning) {
  Page page(1'000);  // the dispatch put its start a context switch into the future
  page.last_shown_ns = page.base_time_ns;
  EXPECT_EQ(ShownTime(page, ReadClockAt(page, 900)), 1'001);
}

// It has shown 400 ns that it has not computed yet.
TEST(ClockPage, UntilItHasMadeUpForWhatItHasShownItGoesAtHalfItsRate) {
  Page page(0);
  page.last_shown_ns = 1'400;
  EXPECT_EQ(ShowTime(page, ReadClockAt(page, 100)), 1'450);
  EXPECT_EQ(ShowTime(page, ReadClockAt(page, 100)), 1'451);
  EXPECT_EQ(ShowTime(page, ReadClockAt(page, 400)), 1'601);
  EXPECT_EQ(ShowTime(page, ReadClockAt(page, 900)), 1'900);
  EXPECT_EQ(ShowTime(page, ReadClockAt(page, 950)), 1'950);
}

TEST(ClockPage, NeitherDoesItStandStillWhereStolenTimeIsFound) {
  Page page(0);
  EXPECT_EQ(ShowTime(page, ReadClockAt(page, 1'000)), 2'000);
  ASSERT_TRUE(RemoveStolen(page, ReadClockAt(page, 1'000), 700));
  EXPECT_EQ(ShowTime(page, ReadClockAt(page, 1'100)), 2'050);
  EXPECT_EQ(ShowTime(page, ReadClockAt(page, 1'500)), 2'200);
  EXPECT_EQ(ShowTime(page, ReadClockAt(page, 1'600)), 2'300);
}

// While others had the processor nothing was computed.
TEST(ClockPage, WhatWasStolenMakesUpForNothing) {
  Page page(0);
  EXPECT_EQ(ShowTime(page, ReadClockAt(page, 1'000)), 2'000);
  ASSERT_TRUE(RemoveStolen(page, ReadClockAt(page, 3'100), 1'000));
  EXPECT_EQ(ShowTime(page, ReadClockAt(page, 3'100)), 2'001);
  EXPECT_EQ(ShowTime(page, ReadClockAt(page, 3'300)), 2'200);
}

TEST(ClockPage, MakingUpItDoesNotPassItsHorizon) {
  Page page(0);
  page.last_shown_ns = 4'990;
  EXPECT_EQ(ShowTime(page, ReadClockAt(page, 100)), 5'000);
  EXPECT_EQ(ShowTime(page, ReadClockAt(page, 200)), 5'000);
}

// Where computing takes no time, nothing is made up for by it.
TEST(ClockPage, UnderSetCostsItStandsStill) {
  Page page(0);
  page.ns_per_tick_q32 = 0;
  page.last_shown_ns = 1'400;
  EXPECT_EQ(ShowTime(page, ReadClockAt(page, 100)), 1'400);
}

TEST(ClockPage, StolenTimeIsTakenOutAndCounted) {
  Page page(0);
  const ClockReading r = ReadClockAt(page, 1'000);
  ASSERT_TRUE(RemoveStolen(page, r, 600));  // the CPU clock saw 600 ns of the 1,000
  EXPECT_EQ(ReadClockAt(page, 1'000).cpu_ns, 600);
  EXPECT_EQ(page.stolen_ns, 400);
  EXPECT_FALSE(IsCheckDue(page, ReadClockAt(page, 1'000)));
}

TEST(ClockPage, TakingStolenTimeOutDoesNotTurnTheRunTimeBack) {
  Page page(0);
  const ClockReading before = ReadClockAt(page, 1'000);
  ASSERT_EQ(RunTime(page, before), 1'000);
  ASSERT_TRUE(RemoveStolen(page, before, 600));
  const ClockReading after = ReadClockAt(page, 1'400);
  EXPECT_EQ(after.cpu_ns, before.cpu_ns);  // the charge is the same a second time
  EXPECT_EQ(RunTime(page, after), 1'400);
}

TEST(ClockPage, WhatNoClockTellsOfIsTakenOutOfBoth) {
  Page page(0);
  RemoveUnaccounted(page, ReadClockAt(page, 1'000), 700);
  EXPECT_EQ(ReadClockAt(page, 1'000).cpu_ns, 300);
  EXPECT_EQ(page.stolen_ns, 700);
  ASSERT_TRUE(RemoveStolen(page, ReadClockAt(page, 1'500), 1'500));  // it is on the CPU clock
  EXPECT_EQ(ReadClockAt(page, 1'500).cpu_ns, 800);
  EXPECT_EQ(page.stolen_ns, 700);
}

TEST(ClockPage, WhatTheTscMissedIsAdded) {
  Page page(0);
  ASSERT_TRUE(RemoveStolen(page, ReadClockAt(page, 1'000), 1'300));
  EXPECT_EQ(ReadClockAt(page, 1'000).cpu_ns, 1'300);
  EXPECT_EQ(page.stolen_ns, 0);
}

TEST(ClockPage, TheWorkOfTcsTakesAsLongOnASlowComputer) {
  Page page(0);
  page.ns_per_tick_q32 = page.ns_per_host_ns_q32 = 10 * kOnePerTick;
  TakeOut(page, ReadClockAt(page, 900), 9'000, 1'000);
  EXPECT_EQ(ReadClockAt(page, 900).cpu_ns, 0);
  EXPECT_EQ(page.host_cpu_origin_ns, 900);
  TakeOut(page, ReadClockAt(page, 2'000), 11'000, 1'000);
  EXPECT_EQ(ReadClockAt(page, 2'000).cpu_ns, 11'000);
}

TEST(ClockPage, OnASlowComputerItsCpuClockCountsLessOfIt) {
  Page page(100);
  page.ns_per_host_ns_q32 = 2 * kOnePerTick;
  TakeOut(page, ReadClockAt(page, 500), 400, 1'000);
  EXPECT_EQ(ReadClockAt(page, 500).time_ns, 1'000);
  EXPECT_EQ(ReadClockAt(page, 800).cpu_ns, 300);
  EXPECT_EQ(page.host_cpu_origin_ns, 200) << "its CPU clock went on half as fast";
}

TEST(ClockPage, WhatTheExchangeTookLastIsNeitherTimeNorCharge) {
  Page page(0);
  TakeOut(page, ReadClockAt(page, 500), 200, 1'000);
  EXPECT_EQ(ReadClockAt(page, 500).cpu_ns, 300);
  EXPECT_EQ(ReadClockAt(page, 800).time_ns, 1'600);
  EXPECT_EQ(page.host_cpu_origin_ns, 200);
  TakeOut(page, ReadClockAt(page, 900), 1'001, 1'000);  // somebody else had the processor
  EXPECT_EQ(ReadClockAt(page, 900).cpu_ns, 700);
}

// The TSC counts what others had; of its own time only what it took to leave is not the thread's.
TEST(ClockPage, AClockThatLeavesItsGateGoesOnFromWhereItStood) {
  Page page(100);
  page.host_cpu_origin_ns = 10'000;
  const std::int64_t stood_at = 300, leaving = 40, of_others = 7'000;
  const std::uint64_t now = 100 + stood_at + leaving + of_others;
  LeaveGate(page, ReadClockAt(page, now), stood_at, 10'000 + stood_at + leaving, 50);
  EXPECT_EQ(ReadClockAt(page, now).cpu_ns, stood_at);
  EXPECT_EQ(ReadClockAt(page, now + 5).time_ns, 1'000 + stood_at + 5);
  EXPECT_EQ(page.host_cpu_origin_ns, 10'000 + leaving);
  EXPECT_FALSE(IsCheckDue(page, ReadClockAt(page, now)));
  EXPECT_EQ(page.stolen_ns, 0);
}

TEST(ClockPage, WhatAHandlerDidBeforeTheGateOpenedIsTheThreads) {
  Page page(100);
  const std::int64_t stood_at = 300, handler = 2'000;
  LeaveGate(page, ReadClockAt(page, 9'000), stood_at, stood_at + handler, 50);
  EXPECT_EQ(ReadClockAt(page, 9'000).cpu_ns, stood_at + handler);
  EXPECT_EQ(page.host_cpu_origin_ns, 0);
}

TEST(ClockPage, ADispatchInBetweenMakesACorrectionFail) {
  Page page(0);
  const ClockReading before = ReadClockAt(page, 1'000);
  page.executed_adjust = PackAdjust(std::uint64_t{2} << kAdjustBits, 0);
  EXPECT_FALSE(RemoveStolen(page, before, 600));
  EXPECT_EQ(ReadClockAt(page, 1'000).cpu_ns, 1'000);
}

TEST(ClockPage, AdjustmentsKeepTheirSignAndTheirNumber) {
  constexpr std::int64_t kMost = (std::int64_t{1} << (kAdjustBits - 1)) - 1;
  for (const std::int64_t value :
       {std::int64_t{0}, std::int64_t{1}, std::int64_t{-1}, kMost, -kMost}) {
    const std::uint64_t word = PackAdjust(std::uint64_t{0xffff} << kAdjustBits, value);
    EXPECT_EQ(AdjustValue(word), value);
    EXPECT_EQ(DispatchNumber(word), 0xffffu);
  }
  EXPECT_GE(kMost, kMaxDispatchNs) << "the furthest horizon must fit";
}

TEST(ClockPage, LongTimesAreMultipliedWithoutOverflow) {
  EXPECT_EQ(MulQ32(kMaxDispatchNs, kOnePerTick), kMaxDispatchNs);
  EXPECT_EQ(MulQ32(-1'000, 3 * kOnePerTick), -3'000);
  EXPECT_EQ(MulQ32(INT64_MAX, kOnePerTick / 2), INT64_MAX / 2);
}

TEST(ClockPage, AReadingOfTheRunningClockIsConsistent) {
  const Page page(__rdtsc());
  std::int64_t last = 0;
  for (int i = 0; i < 1'000; ++i) {
    const ClockReading r = ReadClock(page);
    EXPECT_GE(r.time_ns, last);
    EXPECT_EQ(r.time_ns - page.base_time_ns, r.cpu_ns);
    last = r.time_ns;
  }
}

}  // namespace
}  // namespace tcs::shm
