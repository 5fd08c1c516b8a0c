// With a thread of this process that waits at a gate as the shim does, and real processors.
#include "coordinator/host/beside_cpu.h"

#include <gtest/gtest.h>
#include <linux/futex.h>
#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <x86gprintrin.h>

#include <atomic>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "coordinator/host/host_cpu.h"
#include "coordinator/os/cpu_places.h"
#include "tests/unit/host/noting_executor.h"

namespace tcs {
namespace {

using shm::Saying;

class BesideCpuTest : public testing::Test {
 protected:
  void SetUp() override {
    const std::vector<CpuPlace> cpus = CpuPlaces();
    if (cpus.size() < 2) GTEST_SKIP() << "this machine has one processor";
    home_ = cpus[0].number;
    cpu_.emplace(cpus[1].number, home_, 1.0, executor_, [this](int) { return is_claimed_.load(); });
    thread_.slot_memory = slot_.get();
    program_ = std::thread([this] { Run(); });
    while (slot_->gate.load() != shm::kGateWaiting) sched_yield();
  }
  void TearDown() override {
    ends_ = true;
    if (program_.joinable()) {
      HostCpu::OpenGate(*slot_);
      program_.join();
    }
  }
  // Turns of the thread: each notes where it is, computes for as long as it is to, and says so.
  void Run() {
    thread_.tid = gettid();
    for (;;) {
      std::uint32_t closed = shm::kGateClosed;
      slot_->gate.compare_exchange_strong(closed, shm::kGateWaiting);
      while (slot_->gate.load() != shm::kGateOpen) {
        syscall(SYS_futex, &slot_->gate, FUTEX_WAIT, shm::kGateWaiting, nullptr, nullptr, 0);
      }
      if (ends_) return;
      do where_ = sched_getcpu();
      while (computes_);
      slot_->gate.store(shm::kGateClosed);
      slot_->stopped_tsc = __rdtsc();
      if (Saying runs = Saying::kRuns;
          !slot_->saying.compare_exchange_strong(runs, Saying::kSaid)) {
        says_by_pipe_ = true;
      }
      ++turns_;
    }
  }

  NotingExecutor executor_;
  int home_ = -1;
  std::unique_ptr<shm::ThreadSlot> slot_ = std::make_unique<shm::ThreadSlot>();
  HostThread thread_;
  std::atomic<bool> ends_{false}, computes_{false}, is_claimed_{false}, says_by_pipe_{false};
  std::atomic<int> where_{-1}, turns_{0};
  std::optional<BesideCpu> cpu_;
  std::thread program_;
};

TEST_F(BesideCpuTest, ATurnIsHadThereAndSaysInTheSlotWhenItHasStopped) {
  const std::uint64_t before_tsc = thread_.grant.base_tsc = __rdtsc();
  ASSERT_TRUE(cpu_->Begin(thread_));
  EXPECT_EQ(cpu_->begun(), 1);
  EXPECT_TRUE(thread_.turns_beside && thread_.is_beside && !thread_.parked);
  while (!BesideCpu::HasSaid(thread_)) sched_yield();
  EXPECT_EQ(where_, cpu_->cpu());
  EXPECT_GT(BesideCpu::StoppedAt(thread_), before_tsc);
  EXPECT_LE(BesideCpu::StoppedAt(thread_), __rdtsc());
  cpu_->Take(thread_);
  EXPECT_EQ(cpu_->begun(), 0);
  EXPECT_EQ(slot_->saying.load(), Saying::kByPipe);
  EXPECT_TRUE(!thread_.turns_beside && thread_.is_beside) << "it stays there";
}

TEST_F(BesideCpuTest, WhenItHasStoppedIsNotBelievedBeyondTheTurn) {
  ASSERT_TRUE(cpu_->Begin(thread_));
  while (!BesideCpu::HasSaid(thread_)) sched_yield();
  thread_.grant.base_tsc = __rdtsc();
  slot_->stopped_tsc = 1;
  EXPECT_EQ(BesideCpu::StoppedAt(thread_), thread_.grant.base_tsc) << "not before it began";
  slot_->stopped_tsc = ~std::uint64_t{0};
  const std::uint64_t stopped_tsc = BesideCpu::StoppedAt(thread_);
  EXPECT_LE(stopped_tsc, __rdtsc()) << "nor in the future";
  cpu_->Take(thread_);
}

TEST_F(BesideCpuTest, WhoeverIsNotWaitedForSaysSoByThePipe) {
  computes_ = true;
  ASSERT_TRUE(cpu_->Begin(thread_));
  while (where_ != cpu_->cpu()) sched_yield();
  EXPECT_TRUE(cpu_->GiveUp(thread_));
  EXPECT_EQ(cpu_->begun(), 0);
  cpu_->BringHome(thread_);
  EXPECT_FALSE(thread_.is_beside);
  EXPECT_EQ(executor_.Told(), std::vector{"hold " + std::to_string(thread_.tid)});
  while (where_ != home_) sched_yield();
  computes_ = false;
  while (turns_ == 0) sched_yield();
  EXPECT_TRUE(says_by_pipe_);
}

TEST_F(BesideCpuTest, NobodyTouchesAThreadThatTheWardenIsAboutToSendHome) {
  std::atomic<bool> is_holding{false};
  executor_.holds = [&](pid_t) {
    is_holding = true;
    usleep(50'000);
    is_holding = false;
  };
  computes_ = true;
  ASSERT_TRUE(cpu_->Begin(thread_));
  while (where_ != cpu_->cpu()) sched_yield();
  EXPECT_TRUE(cpu_->GiveUp(thread_));
  cpu_->BringHome(thread_);
  EXPECT_FALSE(is_holding);
  EXPECT_EQ(executor_.Told(), std::vector{"hold " + std::to_string(thread_.tid)});
  while (where_ != home_) sched_yield();
  computes_ = false;
  while (turns_ == 0) sched_yield();
}

TEST_F(BesideCpuTest, WhoeverHasSaidSomethingIsNotGivenUp) {
  ASSERT_TRUE(cpu_->Begin(thread_));
  while (turns_ == 0) sched_yield();
  EXPECT_FALSE(cpu_->GiveUp(thread_));
  EXPECT_EQ(cpu_->begun(), 1);
  cpu_->Take(thread_);
}

TEST_F(BesideCpuTest, AHandlerThatWaitsForTheNoteToBeTakenIsWoken) {
  ASSERT_TRUE(cpu_->Begin(thread_));
  while (turns_ == 0) sched_yield();
  std::atomic<bool> goes_on{false};
  std::thread handler([&] {
    Saying said = Saying::kSaid;
    EXPECT_TRUE(slot_->saying.compare_exchange_strong(said, Saying::kSaidAndWaits));
    while (slot_->saying.load() == Saying::kSaidAndWaits) {
      syscall(SYS_futex, &slot_->saying, FUTEX_WAIT, static_cast<int>(Saying::kSaidAndWaits),
              nullptr, nullptr, 0);
    }
    goes_on = true;
  });
  while (slot_->saying.load() != Saying::kSaidAndWaits) sched_yield();
  EXPECT_TRUE(BesideCpu::HasSaid(thread_));
  EXPECT_FALSE(goes_on);
  cpu_->Take(thread_);
  handler.join();
  EXPECT_TRUE(goes_on);
}

TEST_F(BesideCpuTest, ItIsBusyWhileTurnsFollowEachOtherAndForAMomentAfterwards) {
  EXPECT_FALSE(cpu_->IsBusyAt(__rdtsc()));
  const std::uint64_t now_tsc = __rdtsc();
  for (int i = 0; i < 8; ++i) cpu_->NoteWanted(now_tsc);
  EXPECT_TRUE(cpu_->IsBusyAt(now_tsc));
  EXPECT_FALSE(cpu_->IsBusyAt(now_tsc + 10'000'000)) << "ticks are nanoseconds here";
}

TEST_F(BesideCpuTest, ItIsLeftToOthersForLongerAndLonger) {
  constexpr std::uint64_t kFirst = 2'000'000;
  const std::uint64_t now_tsc = __rdtsc();
  EXPECT_TRUE(cpu_->IsFreeAt(now_tsc));
  cpu_->LeaveToOthers(now_tsc);
  EXPECT_FALSE(cpu_->IsFreeAt(now_tsc + kFirst - 1));
  EXPECT_TRUE(cpu_->IsFreeAt(now_tsc + kFirst));
  cpu_->LeaveToOthers(now_tsc + kFirst);
  EXPECT_FALSE(cpu_->IsFreeAt(now_tsc + 3 * kFirst - 1));
  EXPECT_TRUE(cpu_->IsFreeAt(now_tsc + 3 * kFirst));
}

TEST_F(BesideCpuTest, AnotherRunThatClaimsItHasIt) {
  is_claimed_ = true;
  EXPECT_FALSE(cpu_->IsFreeAt(__rdtsc()));
}

}  // namespace
}  // namespace tcs
