#include "coordinator/host/measured_meter.h"

#include <gtest/gtest.h>

#include "tests/unit/host/meter_times.h"

namespace tcs {
namespace {

// A thread's page, and a processor whose time the test says.
class MeasuredMeterTest : public testing::Test {
 protected:
  MeasuredMeterTest() { thread_.page = &page_; }

  // As the coordinator does it.
  void Dispatch(std::uint64_t tsc, bool from_gate = false) {
    if (!thread_.has_origin()) thread_.host_origin_ns = host_cpu_ns_;
    grant_.base_time_ns = kStart;
    grant_.base_cpu_ns = charged_ns_;
    grant_.horizon_ns = kStart + 20 * kMs;
    meter_.SetRates(thread_, {}, grant_);
    grant_.WriteTo(page_);
    page_.host_cpu_origin_ns = thread_.page_origin_ns = thread_.host_origin_ns;
    page_.executed_adjust = page_.waited_adjust = 0;
    page_.base_tsc = meter_.Begin(thread_, tsc, from_gate, false);
  }
  void End(std::uint64_t tsc) {
    meter_.End(thread_, tsc, clock_);
    charged_ns_ = ReadClockAt(page_, tsc).cpu_ns;
  }
  std::int64_t ClockAt(std::uint64_t tsc) { return ReadClockAt(page_, tsc).time_ns; }

  shm::ClockPage page_{};
  MeteredThread thread_;
  ClockGrant grant_;
  MeasuredMeter meter_{kRate};
  std::int64_t charged_ns_ = 0;
  std::int64_t host_cpu_ns_ = 700 * kMs;
  int asked_ = 0;
  Meter::CpuClock clock_ = [this] {
    ++asked_;
    return host_cpu_ns_;
  };
};

TEST_F(MeasuredMeterTest, TheClockCountsWhatTheTscCounts) {
  Dispatch(kBegun);
  EXPECT_EQ(ClockAt(kBegun), kStart);
  EXPECT_EQ(ClockAt(kBegun + 3 * kTicksPerMs), kStart + 3 * kMs);
}

TEST_F(MeasuredMeterTest, OnASlowComputerComputingTakesLonger) {
  thread_.speed = 0.5;
  Dispatch(kBegun);
  EXPECT_EQ(ClockAt(kBegun + 3 * kTicksPerMs), kStart + 6 * kMs);
  EXPECT_EQ(thread_.OnHost(VirtualNs(6 * kMs)), HostNs(3 * kMs));
  EXPECT_EQ(thread_.OnRobot(HostNs(3 * kMs)), VirtualNs(6 * kMs));
}

TEST_F(MeasuredMeterTest, CallsAndAllocationsCostWhatTheyTake) {
  grant_.call_cost_ns = 1;
  meter_.SetRates(thread_, {.call = VirtualNs(1000), .allocation = VirtualNs(100)}, grant_);
  EXPECT_EQ(grant_.call_cost_ns, 0);
  EXPECT_EQ(grant_.allocation_cost_ns, 0);
  Dispatch(kBegun);
  meter_.ChargeCall(thread_, VirtualNs(1000));
  EXPECT_EQ(ClockAt(kBegun), kStart);
}

TEST_F(MeasuredMeterTest, WhatTheCpuClockDidNotCountIsStolen) {
  Dispatch(kBegun);
  host_cpu_ns_ += 2 * kMs;
  meter_.Check(thread_, kBegun + 5 * kTicksPerMs, clock_);
  EXPECT_EQ(ClockAt(kBegun + 5 * kTicksPerMs), kStart + 2 * kMs);
  EXPECT_EQ(page_.stolen_ns.load(), 3 * kMs);
}

TEST_F(MeasuredMeterTest, ACpuClockThatCannotBeReadTellsNothing) {
  Dispatch(kBegun);
  host_cpu_ns_ = -1;
  meter_.Check(thread_, kBegun + 5 * kTicksPerMs, clock_);
  EXPECT_EQ(ClockAt(kBegun + 5 * kTicksPerMs), kStart + 5 * kMs);
}

TEST_F(MeasuredMeterTest, TheCpuClockIsAskedOnlyAfterMuchHasPassed) {
  Dispatch(kBegun);
  End(kBegun + 90 * kTicksPerUs);
  EXPECT_EQ(asked_, 0);
  Dispatch(kBegun + kTicksPerMs);  // what has not been checked adds up
  host_cpu_ns_ += 20 * kUs;
  End(kBegun + kTicksPerMs + 20 * kTicksPerUs);
  EXPECT_EQ(asked_, 1);
}

// A thread whose turns begin at its gate and after a preemption by turns: between two looks at its
// CPU clock it has both. The first takes 5 us by the TSC that the thread has not had, the other 2.
TEST_F(MeasuredMeterTest, SingleRunsTellOfSwitchesWhereRunsAreOfBothKinds) {
  std::uint64_t tsc = kBegun;
  for (int i = 0; i < 20'000; ++i, tsc += kTicksPerMs) {
    const bool from_gate = i % 2 == 0;
    Dispatch(tsc, from_gate);
    host_cpu_ns_ += 8 * kUs;
    End(tsc + (from_gate ? 13 : 10) * kTicksPerUs);
  }
  EXPECT_NEAR(static_cast<double>(meter_.Begin(thread_, tsc, true, false) - tsc), 5 * kTicksPerUs,
              50);
  EXPECT_NEAR(static_cast<double>(meter_.Begin(thread_, tsc, false, false) - tsc), 2 * kTicksPerUs,
              50);
  EXPECT_LT(asked_, 20'000 / 5);
}

// The thread's CPU clock counts what it does on its way to its gate, after its turn: 3 us.
TEST_F(MeasuredMeterTest, WaysToTheGateAreNotCharged) {
  std::uint64_t tsc = kBegun;
  for (int i = 0; i < 400; ++i, tsc += kTicksPerMs) {
    Dispatch(tsc, true);
    host_cpu_ns_ += 203 * kUs;
    End(tsc + 200 * kTicksPerUs);
  }
  const std::int64_t charged_ns = charged_ns_;
  Dispatch(tsc, true);
  host_cpu_ns_ += 203 * kUs;
  End(tsc + 200 * kTicksPerUs);
  EXPECT_NEAR(static_cast<double>(charged_ns_ - charged_ns), 200 * kUs, 50);
  EXPECT_EQ(page_.host_cpu_origin_ns, thread_.page_origin_ns);
}

// Each run takes 200 us by the TSC, the way there and back included, and the thread has had 195.
TEST_F(MeasuredMeterTest, WhatIsStolenAtEachDispatchIsTheSwitch) {
  std::uint64_t tsc = kBegun;
  for (int i = 0; i < 200; ++i, tsc += kTicksPerMs) {
    Dispatch(tsc, true);
    host_cpu_ns_ += 195 * kUs;
    End(tsc + 200 * kTicksPerUs);
  }
  EXPECT_NEAR(static_cast<double>(meter_.Begin(thread_, tsc, true, false) - tsc), 5 * kTicksPerUs,
              2);
  EXPECT_EQ(meter_.Begin(thread_, tsc, false, false), tsc) << "of preempted ones nothing is known";
}

TEST_F(MeasuredMeterTest, WhatTheThreadFoundItselfIsNoSwitch) {
  Dispatch(kBegun);
  page_.last_check_tsc = kBegun + 10 * kTicksPerUs;
  meter_.Check(thread_, kBegun + 5 * kTicksPerMs, clock_);
  EXPECT_EQ(meter_.Begin(thread_, kBegun, false, false), kBegun);
}

TEST_F(MeasuredMeterTest, IsLookedAtShortlyBeforeItsHorizon) {
  Dispatch(kBegun);
  const std::int64_t ns = meter_.TimeToLook(thread_, kBegun, OwnTime(kStart + kMs)).ns();
  EXPECT_LT(ns, kMs);
  EXPECT_GT(ns, kMs - 50 * kUs);
}

TEST_F(MeasuredMeterTest, AtItsHorizonItHasToStop) {
  Dispatch(kBegun);
  host_cpu_ns_ += kMs;
  meter_.TimeToLook(thread_, kBegun, OwnTime(kStart + kMs));
  EXPECT_EQ(meter_.Look(thread_, kBegun + kTicksPerMs, OwnTime(kStart + kMs), clock_),
            Meter::Found::kAtHorizon);
}

TEST_F(MeasuredMeterTest, AThreadThatWasStolenFromHasNotComeToItsHorizon) {
  Dispatch(kBegun);
  host_cpu_ns_ += kMs / 2;
  meter_.TimeToLook(thread_, kBegun, OwnTime(kStart + kMs));
  EXPECT_EQ(meter_.Look(thread_, kBegun + kTicksPerMs, OwnTime(kStart + kMs), clock_),
            Meter::Found::kGoesOn);
  EXPECT_EQ(asked_, 1);
}

TEST_F(MeasuredMeterTest, WhoTakesOutMoreThanItHasRunIsChargedWhatItsCpuClockSays) {
  Dispatch(kBegun);
  const std::uint64_t tsc = kBegun + 20 * kTicksPerUs;  // too early for a check
  host_cpu_ns_ += 15 * kUs;
  page_.executed_adjust = shm::PackAdjust(page_.executed_adjust.load(), -50 * kMs);
  End(tsc);
  EXPECT_EQ(ClockAt(tsc), kStart + 15 * kUs);
  EXPECT_EQ(asked_, 1);
}

TEST_F(MeasuredMeterTest, WhatItFindsStolenItMayTakeOut) {
  Dispatch(kBegun);
  const std::uint64_t tsc = kBegun + 900 * kTicksPerUs;
  page_.executed_adjust = shm::PackAdjust(page_.executed_adjust.load(), -500 * kUs);
  page_.last_check_tsc = tsc;
  End(tsc);
  EXPECT_EQ(ClockAt(tsc), kStart + 400 * kUs);
  EXPECT_EQ(asked_, 0);
}

TEST_F(MeasuredMeterTest, ThatItHasAskedItsCpuClockIsNotBelievedForLong) {
  std::uint64_t tsc = kBegun;
  for (int i = 0; i < 100; ++i, tsc += kTicksPerMs) {
    Dispatch(tsc);
    host_cpu_ns_ += 200 * kUs;
    // It has computed nothing, as it says.
    page_.executed_adjust = shm::PackAdjust(page_.executed_adjust.load(), -200 * kUs);
    page_.last_check_tsc = tsc + 200 * kTicksPerUs;
    End(tsc + 200 * kTicksPerUs);
  }
  EXPECT_GT(charged_ns_, 19 * kMs);
  EXPECT_LT(asked_, 20);
}

// A look that asks each time finds what switches take each time: of a slow computer's thread that
// is more than what it computes in between, and it would never come to its horizon.
TEST_F(MeasuredMeterTest, LooksDoNotAskMoreOftenForThat) {
  Dispatch(kBegun);
  const std::uint64_t tsc = kBegun + 5 * kTicksPerMs;
  page_.last_check_tsc = tsc;
  meter_.TimeToLook(thread_, kBegun, OwnTime(kStart + 5 * kMs));
  EXPECT_EQ(meter_.Look(thread_, tsc, OwnTime(kStart + 5 * kMs), clock_), Meter::Found::kAtHorizon);
  EXPECT_EQ(asked_, 0);
}

TEST_F(MeasuredMeterTest, NorIsItInItsLastTurn) {
  Dispatch(kBegun);
  const std::uint64_t tsc = kBegun + 300 * kTicksPerUs;
  host_cpu_ns_ += 300 * kUs;
  page_.executed_adjust = shm::PackAdjust(page_.executed_adjust.load(), -300 * kUs);
  page_.last_check_tsc = tsc;
  thread_.AuditAtEnd();
  End(tsc);
  EXPECT_EQ(charged_ns_, 300 * kUs);
}

TEST_F(MeasuredMeterTest, WhoMayStillRunIsNotAsked) {
  Dispatch(kBegun);
  const std::uint64_t tsc = kBegun + 5 * kTicksPerMs;
  page_.last_check_tsc = tsc;
  thread_.can_be_audited = false;
  End(tsc);
  EXPECT_EQ(asked_, 0);
}

TEST_F(MeasuredMeterTest, LearnsHowLateTimersAre) {
  Dispatch(kBegun);
  page_.check_after_ticks = ~std::uint64_t{0};  // nothing is stolen
  const std::int64_t first_ns = meter_.TimeToLook(thread_, kBegun, OwnTime(kStart + 2 * kMs)).ns();
  for (int i = 0; i < 100; ++i) {
    const std::int64_t ns = meter_.TimeToLook(thread_, kBegun, OwnTime(kStart + 2 * kMs)).ns();
    const auto late = static_cast<std::uint64_t>(2 * (ns + 40 * kUs));
    host_cpu_ns_ = 700 * kMs + ns + 40 * kUs;
    meter_.Look(thread_, kBegun + late, OwnTime(kStart + 2 * kMs), clock_);
  }
  EXPECT_NEAR(
      static_cast<double>(meter_.TimeToLook(thread_, kBegun, OwnTime(kStart + 2 * kMs)).ns()),
      static_cast<double>(first_ns - 35 * kUs), kUs);
}

TEST_F(MeasuredMeterTest, OverSleepingTellsOfTheftsThatNoClockTellsOf) {
  Dispatch(kBegun);
  EXPECT_FALSE(meter_.HasOverslept(kBegun, kBegun + 4 * kTicksPerMs, HostNs(4 * kMs)));
  EXPECT_FALSE(meter_.HasOverslept(kBegun, kBegun + 5 * kTicksPerMs, HostNs(4 * kMs)));
  EXPECT_TRUE(meter_.HasOverslept(kBegun, kBegun + 50 * kTicksPerMs, HostNs(4 * kMs)));
}

// The host counts as the thread's what the hypervisor had: all clocks have 50 ms, the timer was to
// come after 4.
TEST_F(MeasuredMeterTest, WhatNoClockTellsIsTakenOutOfAll) {
  Dispatch(kBegun);
  const std::uint64_t tsc = kBegun + 50 * kTicksPerMs;
  const shm::ClockReading before = ReadClockAt(page_, kBegun);
  const std::int64_t origin_ns = thread_.host_origin_ns;
  host_cpu_ns_ += 50 * kMs;
  EXPECT_EQ(meter_.TakeOutUnaccounted(thread_, before, tsc, HostNs(4 * kMs), clock_),
            HostNs(46 * kMs));
  EXPECT_EQ(ClockAt(tsc), kStart + 4 * kMs);
  EXPECT_EQ(thread_.host_origin_ns, origin_ns + 46 * kMs);
  EXPECT_EQ(thread_.page_origin_ns, page_.host_cpu_origin_ns);
  meter_.Check(thread_, tsc, clock_);
  EXPECT_EQ(ClockAt(tsc), kStart + 4 * kMs) << "the CPU clock is believed again";
}

TEST_F(MeasuredMeterTest, WhatTheCpuClockTellsIsNotTakenOutTwice) {
  Dispatch(kBegun);
  const std::uint64_t tsc = kBegun + 50 * kTicksPerMs;
  const shm::ClockReading before = ReadClockAt(page_, kBegun);
  host_cpu_ns_ += 3 * kMs;
  EXPECT_EQ(meter_.TakeOutUnaccounted(thread_, before, tsc, HostNs(4 * kMs), clock_), HostNs(0));
  EXPECT_EQ(ClockAt(tsc), kStart + 3 * kMs);
}

}  // namespace
}  // namespace tcs
