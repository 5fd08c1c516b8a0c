#include "coordinator/host/fixed_meter.h"

#include <gtest/gtest.h>

#include "tests/unit/host/meter_times.h"

namespace tcs {
namespace {

constexpr HostDuration kSilentAfter = HostDuration::Seconds(5);
constexpr ProgramTime kFar = OwnTime(kStart + 1000 * kMs);

class FixedMeterTest : public testing::Test {
 protected:
  FixedMeterTest() {
    thread_.page = &page_;
    grant_.base_time_ns = kStart;
    meter_.SetRates(thread_, {.call = VirtualNs(1000), .allocation = VirtualNs(100)}, grant_);
    grant_.WriteTo(page_);
    page_.base_tsc = meter_.Begin(thread_, 0, true, false);
  }

  // The thread has computed for so long by its CPU clock, and is looked at.
  Meter::Found Compute(HostDuration computed, ProgramTime horizon = kFar) {
    cpu_ns_ += computed.ns();
    return meter_.Look(thread_, tsc_, horizon, clock_);
  }
  std::int64_t Clock() { return ReadClockAt(page_, tsc_).time_ns; }

  shm::ClockPage page_{};
  MeteredThread thread_;
  ClockGrant grant_;
  FixedMeter meter_{kSilentAfter};
  std::uint64_t tsc_ = 0;
  std::int64_t cpu_ns_ = 7 * kMs;
  Meter::CpuClock clock_ = [this] { return cpu_ns_; };
};

TEST_F(FixedMeterTest, ComputingTakesNoTime) {
  tsc_ = 1'000'000'000'000;
  EXPECT_EQ(Clock(), kStart);
  meter_.Check(thread_, tsc_, clock_);
  meter_.End(thread_, tsc_, clock_);
  EXPECT_EQ(Clock(), kStart);
}

TEST_F(FixedMeterTest, TheShimChargesCallsAndAllocations) {
  EXPECT_EQ(page_.call_cost_ns, 1000);
  EXPECT_EQ(page_.allocation_cost_ns, 100);
}

TEST_F(FixedMeterTest, ACallThatTheShimDoesNotSeeCostsTheSame) {
  page_.executed_adjust = shm::PackAdjust(std::uint64_t{7} << shm::kAdjustBits, 300);
  meter_.ChargeCall(thread_, VirtualNs(1000));
  EXPECT_EQ(Clock(), kStart + 1300);
  EXPECT_EQ(shm::DispatchNumber(page_.executed_adjust.load()), 7);
}

TEST_F(FixedMeterTest, NoSleepOfTheCoordinatorsIsTooLong) {
  EXPECT_FALSE(meter_.HasOverslept(0, ~std::uint64_t{0}, HostNs(1)));
  EXPECT_EQ(meter_.TakeOutUnaccounted(thread_, {}, tsc_, HostNs(1), clock_), HostDuration());
}

TEST_F(FixedMeterTest, WhoComputesForLongWithoutACallIsSilent) {
  EXPECT_EQ(Compute({}), Meter::Found::kGoesOn);  // here it is seen first
  EXPECT_EQ(Compute(kSilentAfter - HostNs(1)), Meter::Found::kGoesOn);
  EXPECT_EQ(Compute(HostNs(1)), Meter::Found::kIsSilent);
}

TEST_F(FixedMeterTest, WaitingForTheProcessorIsNoSilence) {
  for (int i = 0; i < 1000; ++i) {
    tsc_ += 1'000'000'000;
    EXPECT_EQ(Compute({}), Meter::Found::kGoesOn);
  }
}

TEST_F(FixedMeterTest, AnyCallBreaksTheSilence) {
  EXPECT_EQ(Compute({}), Meter::Found::kGoesOn);
  page_.executed_adjust += 1000;
  EXPECT_EQ(Compute(kSilentAfter), Meter::Found::kGoesOn);
  EXPECT_EQ(Compute(kSilentAfter), Meter::Found::kIsSilent);
}

class PaysForSilence : public FixedMeterTest {
 protected:
  static constexpr std::int64_t kLookNs = FixedMeter::kLookAtSilentEvery.ns();
  static constexpr std::int64_t kCostNs = FixedMeter::kSilentCost.ns();

  PaysForSilence() {
    thread_.pays_for_silence = true;
    EXPECT_EQ(Compute({}), Meter::Found::kGoesOn);  // here it is seen first
  }
};

TEST_F(PaysForSilence, AsMuchAsItComputes) {
  EXPECT_EQ(Clock(), kStart);
  for (int i = 1; i <= 5; ++i) {
    EXPECT_EQ(Compute(HostNs(kLookNs)), Meter::Found::kGoesOn);
    EXPECT_EQ(Clock(), kStart + i * kCostNs);
  }
}

TEST_F(PaysForSilence, WhatIsLeftCountsForTheNextTime) {
  Compute(HostNs(kLookNs - 1));
  EXPECT_EQ(Clock(), kStart);
  Compute(HostNs(kLookNs));
  EXPECT_EQ(Clock(), kStart + kCostNs);
  EXPECT_EQ(meter_.TimeToLook(thread_, tsc_, kFar), HostNs(50'000));  // not at once
  Compute(HostNs(1));
  EXPECT_EQ(Clock(), kStart + 2 * kCostNs);
  EXPECT_EQ(meter_.TimeToLook(thread_, tsc_, kFar), HostNs(kLookNs));
}

TEST_F(PaysForSilence, OnceForEachLook) {
  Compute(HostNs(100 * kLookNs));
  EXPECT_EQ(Clock(), kStart + kCostNs);
  Compute(HostNs(kLookNs - 1));
  EXPECT_EQ(Clock(), kStart + kCostNs);
}

TEST_F(PaysForSilence, ACallBreaksIt) {
  Compute(HostNs(kLookNs - 1));
  page_.executed_adjust += 1000;
  Compute(HostNs(1));
  EXPECT_EQ(Clock(), kStart + 1000);
  Compute(HostNs(kLookNs));
  EXPECT_EQ(Clock(), kStart + 1000 + kCostNs);
}

TEST_F(PaysForSilence, ATurnThatBeganInTheMidstOfItDoesNot) {
  Compute(HostNs(kLookNs - 1));
  meter_.Begin(thread_, tsc_, false, false);
  Compute(HostNs(1));
  EXPECT_EQ(Clock(), kStart + kCostNs);
}

TEST_F(PaysForSilence, ItComesToItsHorizon) {
  const ProgramTime horizon = OwnTime(kStart + 2 * kCostNs);
  EXPECT_EQ(Compute(HostNs(kLookNs), horizon), Meter::Found::kGoesOn);
  EXPECT_EQ(Compute(HostNs(kLookNs), horizon), Meter::Found::kAtHorizon);
}

}  // namespace
}  // namespace tcs
