#include "coordinator/host/host_cpu.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <x86gprintrin.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/host/fixed_meter.h"
#include "coordinator/host/measured_meter.h"
#include "tests/unit/host/nanoseconds.h"
#include "tests/unit/host/noting_executor.h"

namespace tcs {
namespace {

using testing::ElementsAre;

// Threads that are numbers and pages; nobody runs.
class HostCpuTest : public testing::Test {
 protected:
  HostCpuTest() {
    thread_.slot_memory = &slot_;
    thread_.metered.page = &slot_.clock;
    EXPECT_EQ(cpu_.Open(std::make_unique<MeasuredMeter>(TscRate{})), "");
  }

  void WritePage() {
    ClockGrant& grant = thread_.grant;
    grant.base_time_ns = 50 * kMs;
    grant.horizon_ns = 60 * kMs;
    cpu_.SetRates(thread_, {}, grant);
    grant.WriteTo(slot_.clock);
    ++thread_.dispatches;
    slot_.clock.executed_adjust = slot_.clock.waited_adjust = thread_.DispatchWord();
  }

  void End() {
    shm::ClockPage page;
    shm::CopyPage(slot_.clock, &page);
    cpu_.End(thread_, clock_, &page);
  }

  NotingExecutor executor_;
  HostCpu cpu_{executor_, HostDuration::Seconds(10)};
  shm::ThreadSlot slot_{};
  HostThread thread_{.tid = 1}, other_{.tid = 2};
  Meter::CpuClock clock_ = [] { return std::int64_t{0}; };
};

TEST_F(HostCpuTest, TheDispatchedThreadMayRunAndTheDetectorWatches) {
  cpu_.Dispatch(thread_);
  EXPECT_THAT(executor_.Told(), ElementsAre("run 1"));
  EXPECT_FALSE(thread_.parked);
  EXPECT_TRUE(cpu_.detector().is_armed());
  cpu_.Dispatch(other_);
  EXPECT_THAT(executor_.Told(), ElementsAre("hold 1", "run 2"));
}

TEST_F(HostCpuTest, AGateIsOpenedWhetherTheThreadWaitsThereOrNot) {
  for (const std::uint32_t gate : {shm::kGateClosed, shm::kGateWaiting}) {
    slot_.gate = gate;
    HostCpu::OpenGate(slot_);
    EXPECT_EQ(slot_.gate.load(), shm::kGateOpen);
  }
}

// Where the host stops this process between the two it begins with the dispatch, for the thread may
// have run: then it is dispatched again.
TEST_F(HostCpuTest, ItsClockBeginsWhenItStarts) {
  std::uint64_t dispatched_tsc = 0;
  do {
    WritePage();
    cpu_.Dispatch(thread_);
    dispatched_tsc = thread_.grant.base_tsc;
    cpu_.Start(thread_, false);
  } while (thread_.grant.base_tsc == dispatched_tsc);
  EXPECT_TRUE(thread_.HasOwnClock());
  EXPECT_EQ(cpu_.ClockOf(thread_).time_ns, 50 * kMs);
  cpu_.Woke();
  EXPECT_GT(cpu_.ClockOf(thread_).time_ns, 50 * kMs);
}

TEST_F(HostCpuTest, WhatTheCoordinatorDoesInBetweenIsNotTheThreads) {
  WritePage();
  cpu_.Dispatch(thread_);
  cpu_.Start(thread_, false);
  cpu_.Woke();
  const std::int64_t stopped_ns = cpu_.ClockOf(thread_).time_ns;
  poll(nullptr, 0, 5);
  cpu_.Continue(thread_);
  EXPECT_EQ(cpu_.ClockOf(thread_).time_ns, stopped_ns);
  EXPECT_TRUE(thread_.HasOwnClock());
}

TEST_F(HostCpuTest, AReadingThatWasInterruptedIsRepeatedAndLosesNothing) {
  WritePage();
  cpu_.Dispatch(thread_);
  cpu_.Start(thread_, false);
  slot_.clock.executed_adjust += 300;
  slot_.clock.waited_adjust += 2000;
  const std::uint64_t before = slot_.clock.executed_adjust.load();
  cpu_.Continue(thread_);
  const std::uint64_t after = slot_.clock.executed_adjust.load();
  EXPECT_NE(shm::DispatchNumber(after), shm::DispatchNumber(before));
  EXPECT_EQ(shm::AdjustValue(after), 300);
  EXPECT_EQ(shm::AdjustValue(slot_.clock.waited_adjust.load()), 2000);
}

TEST_F(HostCpuTest, AThreadThatHasNotRegisteredHasNoClock) {
  cpu_.Dispatch(other_);
  cpu_.Start(other_, false);
  cpu_.Woke();
  cpu_.Continue(other_);
  EXPECT_EQ(other_.dispatches, 0u);
}

TEST_F(HostCpuTest, WhatItsShimHasTakenOutStaysOut) {
  WritePage();
  thread_.metered.host_origin_ns = slot_.clock.host_cpu_origin_ns = 700;
  thread_.metered.page_origin_ns = 700;
  cpu_.Start(thread_, false);
  slot_.clock.host_cpu_origin_ns += 40;  // the way out of its gate
  thread_.metered.host_origin_ns += 5;   // an exec has changed it meanwhile
  HostCpu::AllowWay(thread_);
  End();
  EXPECT_EQ(thread_.metered.host_origin_ns, 745);
  EXPECT_EQ(thread_.metered.page_origin_ns, 740);
}

TEST_F(HostCpuTest, ItsShimTakesOutNoMoreThanItsWaysTake) {
  constexpr std::int64_t kWay = 52'000;
  WritePage();
  thread_.metered.host_origin_ns = 0;
  slot_.clock.host_cpu_origin_ns = kMs;
  HostCpu::AllowWay(thread_);
  HostCpu::FollowOrigin(thread_);
  EXPECT_EQ(slot_.clock.host_cpu_origin_ns, kWay);
  EXPECT_EQ(thread_.metered.page_origin_ns, kWay);
  slot_.clock.host_cpu_origin_ns += kMs;
  HostCpu::FollowOrigin(thread_);
  EXPECT_EQ(slot_.clock.host_cpu_origin_ns, kWay) << "it has gone no other way since";
  // What ways have not taken is saved up, but not for ever.
  for (int i = 0; i < 1'000'000; ++i) HostCpu::AllowWay(thread_);
  for (const std::int64_t odd : {INT64_MAX, INT64_MIN, std::int64_t{0}}) {
    slot_.clock.host_cpu_origin_ns = odd;
    HostCpu::FollowOrigin(thread_);
  }
  EXPECT_EQ(thread_.metered.page_origin_ns, kWay + 2 * kMs);
}

TEST_F(HostCpuTest, OnASlowComputerAWayTakesAsLong) {
  thread_.metered.speed = 0.01;
  WritePage();
  thread_.metered.host_origin_ns = 0;
  HostCpu::AllowWay(thread_);
  slot_.clock.host_cpu_origin_ns = 40'000;
  HostCpu::FollowOrigin(thread_);
  EXPECT_EQ(thread_.metered.host_origin_ns, 40'000);
}

TEST_F(HostCpuTest, BeforeItHasAnOriginNoneIsFollowed) {
  WritePage();
  HostCpu::AllowWay(thread_);
  slot_.clock.host_cpu_origin_ns = 1'000;
  HostCpu::FollowOrigin(thread_);
  EXPECT_FALSE(thread_.metered.has_origin());
}

TEST_F(HostCpuTest, WhatItsProcessWritesMeanwhileDoesNotChangeWhatItsRunHasComeTo) {
  WritePage();
  thread_.metered.host_origin_ns = 0;
  thread_.metered.is_watched = true;  // its CPU clock is asked
  cpu_.Dispatch(thread_);
  cpu_.Start(thread_, false);
  cpu_.Woke();
  shm::ClockPage page;
  shm::CopyPage(slot_.clock, &page);
  slot_.clock.base_cpu_ns = slot_.clock.base_time_ns = INT64_MAX;
  slot_.clock.executed_adjust += 300;
  const std::uint64_t word = slot_.clock.executed_adjust.load();
  cpu_.End(
      thread_, [] { return 7 * kMs; }, &page);
  EXPECT_EQ(shm::ReadClockAt(page, cpu_.stop_tsc()).cpu_ns, 7 * kMs);
  EXPECT_EQ(slot_.clock.executed_adjust.load(), word);
  EXPECT_EQ(thread_.metered.page, &slot_.clock);
}

TEST_F(HostCpuTest, AClockThatItsProcessHasOverwrittenIsNotReckonedWith) {
  WritePage();
  cpu_.Dispatch(thread_);
  cpu_.Start(thread_, false);
  shm::ClockReading long_ago = cpu_.ClockOf(thread_);
  long_ago.tsc -= 1'000'000'000'000;
  slot_.clock.horizon_ns = 1;
  EXPECT_FALSE(thread_.HasOwnClock());
  const std::uint64_t word = slot_.clock.executed_adjust.load();
  EXPECT_EQ(cpu_.TakeOutUnaccounted(thread_, long_ago, HostNs(kMs), clock_), HostDuration());
  EXPECT_EQ(slot_.clock.executed_adjust.load(), word);
}

TEST_F(HostCpuTest, AnIdealThreadsClockStandsWhileItComputes) {
  thread_.metered.is_ideal = true;
  WritePage();
  cpu_.Dispatch(thread_);
  cpu_.Start(thread_, false);
  shm::ClockReading read = shm::ReadClockAt(slot_.clock, __rdtsc() + 1'000'000'000);
  EXPECT_EQ(read.time_ns, 50 * kMs);
  cpu_.ChargeCall(thread_, VirtualNs(3 * kMs), &slot_.clock);
  read = shm::ReadClockAt(slot_.clock, __rdtsc());
  EXPECT_EQ(read.time_ns, 50 * kMs);
}

}  // namespace
}  // namespace tcs
