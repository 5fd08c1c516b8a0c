#include "coordinator/host/shared_cpu_meter.h"

#include <gtest/gtest.h>

#include "tests/unit/host/meter_times.h"

namespace tcs {
namespace {

constexpr std::int64_t kHorizon = kStart + 5 * kMs;

// A thread's page, dispatched at kBegun, and a CPU clock whose time the test says.
class SharedCpuMeterTest : public testing::Test {
 protected:
  SharedCpuMeterTest() {
    thread_.page = &page_;
    thread_.host_origin_ns = thread_.page_origin_ns = host_cpu_ns_;
    ClockGrant grant;
    grant.base_time_ns = kStart;
    grant.horizon_ns = kHorizon;
    meter_.SetRates(thread_, {}, grant);
    grant.WriteTo(page_);
    page_.host_cpu_origin_ns = thread_.host_origin_ns;
    page_.base_tsc = meter_.Begin(thread_, kBegun, true, false);
  }
  std::int64_t ClockAt(std::uint64_t tsc) { return ReadClockAt(page_, tsc).time_ns; }

  shm::ClockPage page_{};
  MeteredThread thread_;
  SharedCpuMeter meter_{kRate};
  std::int64_t host_cpu_ns_ = 700 * kMs;
  Meter::CpuClock clock_ = [this] { return host_cpu_ns_; };
};

TEST_F(SharedCpuMeterTest, AThreadAsksItsCpuClockAtItsFirstLook) {
  EXPECT_EQ(page_.base_tsc, kBegun);
  EXPECT_TRUE(IsCheckDue(page_, ReadClockAt(page_, kBegun)));
}

TEST_F(SharedCpuMeterTest, AThreadThatOthersKeptFromComputingIsNotAtItsHorizon) {
  host_cpu_ns_ += kMs;
  const std::uint64_t late = kBegun + 20 * kTicksPerMs;
  EXPECT_EQ(meter_.Look(thread_, late, OwnTime(kHorizon), clock_), Meter::Found::kGoesOn);
  EXPECT_EQ(ClockAt(late), kStart + kMs);
  host_cpu_ns_ += 4 * kMs;
  EXPECT_EQ(meter_.Look(thread_, late + kTicksPerMs, OwnTime(kHorizon), clock_),
            Meter::Found::kAtHorizon);
}

TEST_F(SharedCpuMeterTest, EachEndAsksHoweverShortTheRunWas) {
  host_cpu_ns_ += 10 * kUs;
  const std::uint64_t end = kBegun + 30 * kTicksPerUs;
  meter_.End(thread_, end, clock_);
  EXPECT_EQ(ClockAt(end), kStart + 10 * kUs);
}

TEST_F(SharedCpuMeterTest, OneThatHasDiedHasComputedNoMoreThanItsClockHasSaid) {
  host_cpu_ns_ += 10 * kUs;
  EXPECT_EQ(meter_.Look(thread_, kBegun + kTicksPerMs, OwnTime(kHorizon), clock_),
            Meter::Found::kGoesOn);
  host_cpu_ns_ = -1;
  const std::uint64_t end = kBegun + 240 * kTicksPerMs;
  meter_.End(thread_, end, clock_);
  EXPECT_EQ(ClockAt(end), kStart + 10 * kUs);
}

// Each look takes time from it, on the same processor.
TEST_F(SharedCpuMeterTest, OneThatOthersKeepFromComputingIsLookedAtLessAndLess) {
  const ProgramTime near = OwnTime(kStart + 30 * kUs);
  std::uint64_t now = kBegun;
  meter_.Check(thread_, now, clock_);
  HostDuration asked = meter_.TimeToLook(thread_, now, near);
  EXPECT_EQ(asked, HostNs(25 * kUs));  // less what timers are late
  for (const std::int64_t us : {40, 80, 160, 320, 500, 500}) {
    now += static_cast<std::uint64_t>(asked.ns() / kUs + 5) * kTicksPerUs;
    EXPECT_EQ(meter_.Look(thread_, now, near, clock_), Meter::Found::kGoesOn);
    asked = meter_.TimeToLook(thread_, now, near);
    EXPECT_EQ(asked, HostNs(us * kUs));
  }
  host_cpu_ns_ += 490 * kUs;
  now += 500 * kTicksPerUs;
  EXPECT_EQ(meter_.Look(thread_, now, near, clock_), Meter::Found::kAtHorizon);
  EXPECT_EQ(meter_.TimeToLook(thread_, now, near), HostNs(20 * kUs));
}

// It may have computed on.
TEST_F(SharedCpuMeterTest, ALateTimerTellsOfNoTheft) {
  EXPECT_FALSE(meter_.HasOverslept(kBegun, kBegun + 1'000 * kTicksPerMs, HostNs(kMs)));
}

}  // namespace
}  // namespace tcs
