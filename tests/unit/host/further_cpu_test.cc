// With a thread of this process that computes, and real processors.
#include "coordinator/host/further_cpu.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>
#include <x86gprintrin.h>

#include <atomic>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "coordinator/os/cpu_places.h"
#include "tests/unit/host/nanoseconds.h"
#include "tests/unit/host/noting_executor.h"

namespace tcs {
namespace {

// A limit that no thread comes to, for however long the kernel holds this one.
constexpr std::int64_t kForLong = 3'600'000 * kMs;

class FurtherCpuTest : public testing::Test {
 protected:
  void SetUp() override {
    const std::vector<CpuPlace> cpus = CpuPlaces();
    if (cpus.size() < 2) GTEST_SKIP() << "this machine has one processor";
    home_ = cpus[0].number;
    cpu_.emplace(cpus[1].number, home_, 1.0, executor_, [this](int) { return is_claimed_.load(); });
    computing_ = std::thread([this] {
      cpu_set_t home;
      CPU_ZERO(&home);
      CPU_SET(home_, &home);
      sched_setaffinity(0, sizeof home, &home);
      thread_.tid = gettid();
      begun_ = true;
      while (!ends_) where_ = sched_getcpu();
    });
    while (!begun_) sched_yield();
  }
  void TearDown() override {
    ends_ = true;
    if (computing_.joinable()) computing_.join();
  }
  void AwaitAt(int cpu) {
    while (where_ != cpu) sched_yield();
  }

  NotingExecutor executor_;
  int home_ = -1;
  std::optional<FurtherCpu> cpu_;
  HostThread thread_;
  std::atomic<bool> begun_{false}, ends_{false}, is_claimed_{false};
  std::atomic<int> where_{-1};
  std::thread computing_;
};

TEST_F(FurtherCpuTest, AThreadGoesThereAndIsSentHomeAtItsLimit) {
  ASSERT_TRUE(cpu_->Send(thread_, __rdtsc(), 3 * kMs));
  EXPECT_TRUE(thread_.is_ahead);
  EXPECT_EQ(cpu_->thread(), &thread_);
  EXPECT_FALSE(cpu_->IsFreeAt(__rdtsc())) << "one at a time";
  while (!cpu_->HasLeft()) sched_yield();
  AwaitAt(home_);
  EXPECT_GE(cpu_->Computed(), 3 * kMs) << "not before";
  EXPECT_TRUE(thread_.is_ahead) << "until it is taken back";
  cpu_->BringHome();
  EXPECT_FALSE(thread_.is_ahead);
  EXPECT_TRUE(cpu_->IsFreeAt(__rdtsc()));
}

TEST_F(FurtherCpuTest, AThreadIsNotOrdinaryOnTheHomeProcessor) {
  cpu_set_t when_let_go;
  CPU_ZERO(&when_let_go);
  executor_.lets_go = [&](pid_t tid) { sched_getaffinity(tid, sizeof when_let_go, &when_let_go); };
  ASSERT_TRUE(cpu_->Send(thread_, __rdtsc(), kForLong));
  AwaitAt(cpu_->cpu());
  cpu_->BringHome();
  EXPECT_TRUE(CPU_ISSET(cpu_->cpu(), &when_let_go));
  EXPECT_FALSE(CPU_ISSET(home_, &when_let_go));
}

// The kernel may let the coordinator stand at any place for 50 ms.
TEST_F(FurtherCpuTest, AThreadIsHeldUntilItIsGuarded) {
  thread_.may_run = true;
  std::vector<std::string> before;
  executor_.lets_go = [&](pid_t) { before = executor_.Told(); };
  ASSERT_TRUE(cpu_->Send(thread_, __rdtsc(), kMs));
  EXPECT_FALSE(thread_.may_run);
  while (!cpu_->HasLeft()) sched_yield();
  EXPECT_EQ(before, std::vector{"hold " + std::to_string(thread_.tid)});
  EXPECT_EQ(executor_.Told(), before) << "by the warden, at home";
  cpu_->BringHome();
}

TEST_F(FurtherCpuTest, OneThatIsWantedBackAtOnceComesBack) {
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(cpu_->Send(thread_, __rdtsc(), kForLong));
    if (i % 20 == 1) AwaitAt(cpu_->cpu());
    cpu_->BringHome();
    ASSERT_FALSE(cpu_->HasLeft());
    ASSERT_TRUE(cpu_->IsFreeAt(__rdtsc()));
  }
  AwaitAt(home_);
}

TEST_F(FurtherCpuTest, WhoIsAllowedMoreGoesOn) {
  ASSERT_TRUE(cpu_->Send(thread_, __rdtsc(), kForLong));
  cpu_->Allow(2 * kForLong);
  AwaitAt(cpu_->cpu());
  EXPECT_FALSE(cpu_->HasLeft());
  cpu_->BringHome();
  AwaitAt(home_);
  EXPECT_LT(cpu_->Computed(), kForLong);
}

// Others may have the processor meanwhile: what its own clock has not counted it has not computed.
TEST_F(FurtherCpuTest, ALookFindsWhatTheThreadHasComputed) {
  clockid_t clock;
  ASSERT_EQ(pthread_getcpuclockid(computing_.native_handle(), &clock), 0);
  const auto by_own_clock = [clock] {
    timespec t;
    clock_gettime(clock, &t);
    return t.tv_sec * 1'000 * kMs + t.tv_nsec;
  };
  ASSERT_TRUE(cpu_->Send(thread_, __rdtsc(), kForLong));
  AwaitAt(cpu_->cpu());
  std::int64_t looked = -1, before = 0, after = 0;
  int looks = 0;
  // Where the kernel holds the warden nobody has looked; the next look is compared with the last.
  for (int tries = 0; tries < 30'000 && looks < 20; ++tries) {
    const std::int64_t begun = by_own_clock();
    // The first look may have begun before.
    if (!cpu_->HaveLooked() || !cpu_->HaveLooked()) continue;
    const std::int64_t now = cpu_->Computed(), ended = by_own_clock();
    if (looked >= 0) {
      ++looks;
      EXPECT_LE(now - looked, ended - before);
      EXPECT_GE(now - looked, begun - after);
    }
    looked = now;
    before = begun;
    after = ended;
  }
  EXPECT_EQ(looks, 20);
  cpu_->BringHome();
}

// To be fetched again would cost more than to wait for what is allowed next.
TEST_F(FurtherCpuTest, WhoIsAllowedMoreWhileAtTheLimitGoesOnThere) {
  // Not beside the warden, which looks on while the thread rests; and on a busy machine the rest
  // may still be over before anybody sees it.
  cpu_set_t before, home;
  sched_getaffinity(0, sizeof before, &before);
  CPU_ZERO(&home);
  CPU_SET(home_, &home);
  sched_setaffinity(0, sizeof home, &home);
  bool goes_on = false;
  for (int tries = 0; tries < 100 && !goes_on; ++tries) {
    ASSERT_TRUE(cpu_->Send(thread_, __rdtsc(), kMs));
    while (!cpu_->Rests() && !cpu_->HasLeft()) sched_yield();
    const bool rests = cpu_->Rests();
    cpu_->Allow(1'000 * kMs);
    while (cpu_->Computed() < 5 * kMs && !cpu_->HasLeft()) sched_yield();
    goes_on = rests && !cpu_->HasLeft();
    cpu_->BringHome();
    AwaitAt(home_);
  }
  sched_setaffinity(0, sizeof before, &before);
  EXPECT_TRUE(goes_on);
}

TEST_F(FurtherCpuTest, WhoIsWantedBackWhileAtTheLimitComesBack) {
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(cpu_->Send(thread_, __rdtsc(), kMs));
    while (!cpu_->Rests() && !cpu_->HasLeft()) sched_yield();
    cpu_->BringHome();
    AwaitAt(home_);
    ASSERT_TRUE(cpu_->IsFreeAt(__rdtsc()));
  }
}

TEST_F(FurtherCpuTest, WhereOthersHelpNobodyRests) {
  cpu_->LetNobodyRest();
  ASSERT_TRUE(cpu_->Send(thread_, __rdtsc(), kMs));
  while (!cpu_->HasLeft()) ASSERT_FALSE(cpu_->Rests());
  cpu_->BringHome();
}

TEST_F(FurtherCpuTest, OneThatHasEndedIsNoTrouble) {
  ASSERT_TRUE(cpu_->Send(thread_, __rdtsc(), kForLong));
  ends_ = true;
  computing_.join();
  cpu_->BringHome();
  EXPECT_FALSE(cpu_->Send(thread_, __rdtsc(), kMs)) << "it cannot be sent again";
}

TEST_F(FurtherCpuTest, HowLateIsAskedAfterOneThatHasLeftMakesNoDifference) {
  ASSERT_TRUE(cpu_->Send(thread_, __rdtsc(), kMs));
  while (!cpu_->HasLeft()) sched_yield();
  const bool was_starved = cpu_->IsStarvedBy(__rdtsc());
  EXPECT_EQ(cpu_->IsStarvedBy(__rdtsc() + 1'000'000 * kMs), was_starved);
  cpu_->BringHome();
}

TEST_F(FurtherCpuTest, AProcessorThatAnotherRunHasClaimedIsLeftToIt) {
  is_claimed_ = true;
  ASSERT_TRUE(cpu_->Send(thread_, __rdtsc(), kForLong));
  while (!cpu_->HasLeft()) sched_yield();
  EXPECT_TRUE(cpu_->IsStarvedBy(__rdtsc()));
  cpu_->BringHome();
  EXPECT_LT(cpu_->Computed(), kForLong);
  EXPECT_FALSE(cpu_->IsFreeAt(__rdtsc()));
}

TEST_F(FurtherCpuTest, OneThatIsLeftToOthersIsFreeLaterTheOftenerTheLater) {
  cpu_->LeaveToOthers(1'000);
  EXPECT_FALSE(cpu_->IsFreeAt(1'000 + 499 * kMs));
  EXPECT_TRUE(cpu_->IsFreeAt(1'000 + 500 * kMs));
  cpu_->LeaveToOthers(1'000);
  EXPECT_FALSE(cpu_->IsFreeAt(1'000 + 999 * kMs));
  EXPECT_TRUE(cpu_->IsFreeAt(1'000 + 1'000 * kMs));
  // It is of use from then on, and for long.
  const std::uint64_t later_tsc = 1'000 + 2'001 * kMs;
  cpu_->LeaveToOthers(later_tsc);
  EXPECT_FALSE(cpu_->IsFreeAt(later_tsc + 499 * kMs));
  EXPECT_TRUE(cpu_->IsFreeAt(later_tsc + 500 * kMs));
}

}  // namespace
}  // namespace tcs
