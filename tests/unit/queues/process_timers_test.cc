#include "coordinator/queues/process_timers.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/time.h>

#include <climits>
#include <vector>

namespace tcs {
namespace {

using shm::kNeverNs;
using shm::TimerClock;

constexpr std::int64_t kMs = 1'000'000;
constexpr pid_t kThread = 12;

constexpr shm::TimerKind kDescriptor{};
constexpr shm::TimerKind kPosix{
    .is_posix = 1, .signal = SIGUSR1, .signal_tid = kThread, .value = 99};

class ProcessTimersTest : public testing::Test {
 protected:
  // How often that timer runs out at the instant.
  std::int64_t CountAt(ProcessTimers::Id id, std::int64_t now_ns) {
    std::int64_t count = 0;
    for (const auto& timer : timers_.Expire(now_ns)) count += timer.id == id ? timer.count : 0;
    return count;
  }

  void SendAll() {
    for (const TimerSignal& signal : timers_.TakeSignals()) timers_.NoteSent(signal, signal.tid);
  }

  ProcessTimers::Id Armed(const shm::TimerKind& kind, std::int64_t next_ns,
                          std::int64_t interval_ns = 0) {
    const ProcessTimers::Id id = timers_.Create(kind);
    timers_.Set(id, {next_ns, interval_ns}, {});
    return id;
  }

  ProcessTimers timers_;
};

TEST_F(ProcessTimersTest, NothingIsDueAtFirst) {
  EXPECT_EQ(timers_.NextExpiry(), kNeverNs);
  EXPECT_EQ(timers_.NextLook(), kNeverNs);
  EXPECT_FALSE(timers_.HasCpuTimers());
  EXPECT_FALSE(timers_.HasSignals());
  EXPECT_TRUE(timers_.Expire(1'000 * kMs).empty());
}

TEST_F(ProcessTimersTest, WithoutIntervalItRunsOutOnce) {
  const auto id = Armed(kDescriptor, 5 * kMs);
  EXPECT_EQ(timers_.NextExpiry(), 5 * kMs);
  EXPECT_EQ(CountAt(id, 5 * kMs - 1), 0);
  EXPECT_EQ(CountAt(id, 5 * kMs), 1);
  EXPECT_EQ(timers_.Get(id).next_ns, 0);
  EXPECT_EQ(timers_.NextExpiry(), kNeverNs);
  EXPECT_EQ(CountAt(id, 100 * kMs), 0);
}

TEST_F(ProcessTimersTest, WithAnIntervalItRunsOutAgain) {
  const auto id = Armed(kDescriptor, 5 * kMs, 2 * kMs);
  const auto ran_out = timers_.Expire(5 * kMs);
  ASSERT_EQ(ran_out.size(), 1u);
  EXPECT_EQ(ran_out[0].id, id);
  EXPECT_EQ(ran_out[0].count, 1);
  EXPECT_EQ(ran_out[0].clock_ns, 5 * kMs);
  EXPECT_TRUE(ran_out[0].is_periodic);
  EXPECT_EQ(timers_.NextExpiry(), 7 * kMs);
  EXPECT_EQ(CountAt(id, 7 * kMs), 1);
  EXPECT_EQ(timers_.NextExpiry(), 9 * kMs);
}

TEST_F(ProcessTimersTest, WhoeverKeepsItsNextExpiryIsToldOfEachOtherOne) {
  std::vector<std::int64_t> told;
  timers_.TellOfNextExpiry([&] { told.push_back(timers_.NextExpiry()); });
  const auto id = Armed(kDescriptor, 5 * kMs, 2 * kMs);
  const auto later = Armed(kDescriptor, 50 * kMs);
  timers_.Expire(5 * kMs);
  timers_.Delete(id);
  timers_.Set(later, {}, {});
  EXPECT_EQ(told, (std::vector<std::int64_t>{5 * kMs, 7 * kMs, 50 * kMs, kNeverNs}));
}

TEST_F(ProcessTimersTest, WhatRestsIsToldOfAsWell) {
  std::vector<std::int64_t> told;
  Armed(kDescriptor, 5 * kMs, 1'000);
  timers_.TellOfNextExpiry([&] { told.push_back(timers_.NextExpiry()); });
  timers_.Expire(5 * kMs);
  timers_.EndRests(6 * kMs);
  EXPECT_EQ(told, (std::vector<std::int64_t>{kNeverNs, 6 * kMs}));
}

TEST_F(ProcessTimersTest, ManyIntervalsAreCaughtUpWithAtOnce) {
  const auto id = Armed(kDescriptor, 5 * kMs, 2 * kMs);
  EXPECT_EQ(CountAt(id, 5 * kMs + 2'000'000 * kMs + 1), 1'000'001);
  EXPECT_EQ(timers_.Get(id).next_ns, 5 * kMs + 2'000'002 * kMs);
}

TEST_F(ProcessTimersTest, TheEndOfAllTimeNeverComes) {
  const auto once = Armed(kDescriptor, kNeverNs);
  EXPECT_EQ(timers_.NextExpiry(), kNeverNs);
  const auto often = Armed(kDescriptor, 1, kNeverNs);
  EXPECT_EQ(CountAt(often, kMs), 1);
  EXPECT_EQ(timers_.Get(often).next_ns, kNeverNs);
  EXPECT_EQ(timers_.NextExpiry(), kNeverNs);
  EXPECT_EQ(CountAt(once, kNeverNs - 1), 0);
  // As far as one can count.
  const auto most = Armed(kPosix, 1, 1);
  EXPECT_EQ(CountAt(most, kNeverNs - 1), kNeverNs - 1);
  EXPECT_EQ(timers_.Get(most).next_ns, kNeverNs);
}

TEST_F(ProcessTimersTest, SetAnewItRunsOutWhenItIsToNow) {
  const auto id = Armed(kDescriptor, 5 * kMs, kMs);
  timers_.Set(id, {20 * kMs, 0}, {});
  EXPECT_EQ(CountAt(id, 10 * kMs), 0);
  EXPECT_EQ(timers_.NextExpiry(), 20 * kMs);
  timers_.Set(id, {0, kMs}, {});  // not armed
  EXPECT_EQ(timers_.NextExpiry(), kNeverNs);
  EXPECT_EQ(timers_.Get(id).interval_ns, kMs);
  timers_.Set(id, {-7, -7}, {});  // what no program asks for
  EXPECT_EQ(timers_.Get(id).next_ns, 0);
  EXPECT_EQ(timers_.Get(id).interval_ns, 0);
}

TEST_F(ProcessTimersTest, WhatIsNoTimerIsLeftAlone) {
  constexpr ProcessTimers::Id kNone = 77;
  timers_.Set(kNone, {kMs, kMs}, {});
  timers_.Delete(kNone);
  timers_.Accept(kNone);
  timers_.AcceptAt(kNone, kMs);
  EXPECT_FALSE(timers_.KindOf(kNone).has_value());
  EXPECT_EQ(timers_.Get(kNone).next_ns, 0);
  EXPECT_EQ(timers_.Overruns(kNone), 0);
  EXPECT_FALSE(timers_.IsBehind(kNone, kMs));
  EXPECT_EQ(timers_.NextExpiry(), kNeverNs);
}

TEST_F(ProcessTimersTest, TheThreeOfSetitimerAreThereWithoutBeingCreated) {
  EXPECT_EQ(timers_.KindOf(ITIMER_REAL)->signal, SIGALRM);
  EXPECT_EQ(timers_.KindOf(ITIMER_VIRTUAL)->signal, SIGVTALRM);
  EXPECT_EQ(timers_.KindOf(ITIMER_PROF)->signal, SIGPROF);
  EXPECT_EQ(timers_.KindOf(ITIMER_PROF)->clock, TimerClock::kProcessCpu);
  timers_.Set(ITIMER_REAL, {3 * kMs, 0}, {});
  EXPECT_EQ(timers_.NextExpiry(), 3 * kMs);
  timers_.Delete(ITIMER_REAL);  // not for them
  EXPECT_EQ(CountAt(ITIMER_REAL, 3 * kMs), 1);
}

TEST_F(ProcessTimersTest, OneSignalOfSetitimersIsUnderwayAndNotCounted) {
  timers_.Set(ITIMER_REAL, {kMs, kMs}, {});
  timers_.Expire(5 * kMs);
  timers_.Expire(6 * kMs);
  const auto signals = timers_.TakeSignals();
  ASSERT_EQ(signals.size(), 1u);
  EXPECT_EQ(signals[0].number, SIGALRM);
  EXPECT_EQ(signals[0].timer_id, 0);
  EXPECT_EQ(signals[0].tid, 0);
  // Once sent, what is pending is the kernel's to tell.
  timers_.NoteSent(signals[0], 0);
  EXPECT_TRUE(timers_.SentSignals().empty());
  timers_.Expire(7 * kMs);
  EXPECT_TRUE(timers_.HasSignals());
}

TEST_F(ProcessTimersTest, SignalsAreInTheOrderOfTheirExpirationsAndCanBeGivenBack) {
  const auto first = Armed(kPosix, kMs), second = Armed(kPosix, 2 * kMs);
  timers_.Expire(kMs);
  timers_.Expire(2 * kMs);
  auto signals = timers_.TakeSignals();
  ASSERT_EQ(signals.size(), 2u);
  EXPECT_EQ(signals[0].timer_id, first);
  EXPECT_EQ(signals[0].tid, kThread);
  EXPECT_EQ(signals[0].value, 99);
  EXPECT_FALSE(timers_.HasSignals());
  signals[1].taker = 5;
  timers_.NoteSent(signals[0], kThread);
  timers_.GiveBack(signals[1]);
  const auto left = timers_.TakeSignals();
  ASSERT_EQ(left.size(), 1u);
  EXPECT_EQ(left[0].timer_id, second);
  EXPECT_EQ(left[0].taker, 5);
}

TEST_F(ProcessTimersTest, WhatRunsOutBeforeItsSignalIsAcceptedIsOverruns) {
  const auto id = Armed(kPosix, kMs, kMs);
  timers_.Expire(3 * kMs);
  const auto signals = timers_.TakeSignals();
  ASSERT_EQ(signals.size(), 1u);
  EXPECT_EQ(signals[0].overruns, 2);
  timers_.NoteSent(signals[0], kThread);
  timers_.Expire(7 * kMs);
  EXPECT_FALSE(timers_.HasSignals());
  EXPECT_EQ(timers_.Overruns(id), 0);  // none was accepted
  timers_.Accept(id);
  EXPECT_EQ(timers_.Overruns(id), 6);
  // The next one is a signal of its own.
  timers_.Expire(8 * kMs);
  EXPECT_TRUE(timers_.HasSignals());
  EXPECT_EQ(timers_.Overruns(id), 6);
  timers_.Accept(id);
  EXPECT_EQ(timers_.Overruns(id), 0);
}

TEST_F(ProcessTimersTest, OnlySentSignalsCanHaveBeenAccepted) {
  const auto id = Armed(kPosix, kMs, kMs);
  timers_.Expire(kMs);
  EXPECT_TRUE(timers_.SentSignals().empty());
  SendAll();
  const auto sent = timers_.SentSignals();
  ASSERT_EQ(sent.size(), 1u);
  EXPECT_EQ(sent[0].timer_id, id);
  EXPECT_EQ(sent[0].number, SIGUSR1);
  EXPECT_EQ(sent[0].to, kThread);
  timers_.Accept(id);
  EXPECT_TRUE(timers_.SentSignals().empty());
}

TEST_F(ProcessTimersTest, WhoAcceptsASignalHasAllThatHasRunOutByNow) {
  const auto id = Armed(kPosix, kMs, kMs);
  timers_.AcceptAt(id, 9 * kMs);  // nothing is underway: nothing happens
  EXPECT_EQ(timers_.NextExpiry(), kMs);
  timers_.Expire(kMs);
  SendAll();
  timers_.AcceptAt(id, 4 * kMs);
  EXPECT_EQ(timers_.Overruns(id), 3);
  EXPECT_EQ(timers_.NextExpiry(), 5 * kMs);
}

TEST_F(ProcessTimersTest, OverrunsAreNoMoreThanAnIntHolds) {
  const auto id = Armed(kPosix, 1, 1);
  timers_.Expire(1'000'000 * kMs);
  EXPECT_EQ(timers_.TakeSignals().at(0).overruns, INT_MAX);
  timers_.Expire(kNeverNs - 1);
  timers_.Accept(id);
  EXPECT_EQ(timers_.Overruns(id), INT_MAX);
}

TEST_F(ProcessTimersTest, SetAnewItsOverrunsAreForgottenAndASignalUnderwayIsNot) {
  const auto id = Armed(kPosix, kMs, kMs);
  timers_.Expire(3 * kMs);
  timers_.Set(id, {10 * kMs, 0}, {});
  EXPECT_TRUE(timers_.HasSignals());
  SendAll();
  EXPECT_TRUE(timers_.SentSignals().empty());
  timers_.Accept(id);
  EXPECT_EQ(timers_.Overruns(id), 0);
}

TEST_F(ProcessTimersTest, DeletedItsUnsentSignalIsGone) {
  const auto id = Armed(kPosix, kMs, kMs), other = Armed(kPosix, kMs);
  timers_.Expire(kMs);
  timers_.Delete(id);
  EXPECT_FALSE(timers_.KindOf(id).has_value());
  EXPECT_EQ(timers_.NextExpiry(), kNeverNs);
  const auto signals = timers_.TakeSignals();
  ASSERT_EQ(signals.size(), 1u);
  EXPECT_EQ(signals[0].timer_id, other);
}

TEST_F(ProcessTimersTest, DeletedWithASentSignalNobodyWaitsForItsAcceptance) {
  const auto id = Armed(kPosix, kMs);
  timers_.Expire(kMs);
  const auto signals = timers_.TakeSignals();
  timers_.NoteSent(signals[0], kThread);
  timers_.Delete(id);
  EXPECT_TRUE(timers_.SentSignals().empty());
  timers_.Accept(id);
  timers_.NoteSent(signals[0], kThread);
  EXPECT_FALSE(timers_.KindOf(id).has_value());
  EXPECT_NE(timers_.Create(kPosix), id);  // a number is not given twice
}

TEST_F(ProcessTimersTest, AnotherProgramKeepsAllButThoseOfTimerCreate) {
  const auto posix = Armed(kPosix, kMs), descriptor = Armed(kDescriptor, 2 * kMs);
  timers_.Set(ITIMER_REAL, {3 * kMs, 0}, {});
  timers_.DeletePosix();
  EXPECT_FALSE(timers_.KindOf(posix).has_value());
  EXPECT_EQ(timers_.Get(descriptor).next_ns, 2 * kMs);
  EXPECT_EQ(timers_.Get(ITIMER_REAL).next_ns, 3 * kMs);
  EXPECT_EQ(timers_.NextExpiry(), 2 * kMs);
}

TEST_F(ProcessTimersTest, ThereIsRoomForSoMany) {
  timers_.Set(ITIMER_REAL, {kMs, 0}, {});
  timers_.Set(ITIMER_PROF, {kMs, 0}, {});
  for (std::size_t i = 0; i < ProcessTimers::kMost; ++i) {
    ASSERT_FALSE(timers_.IsFull()) << i;
    timers_.Create(kDescriptor);
  }
  EXPECT_TRUE(timers_.IsFull());
  timers_.Delete(shm::kFirstTimerId);
  EXPECT_FALSE(timers_.IsFull());
}

// Processor time.

TEST_F(ProcessTimersTest, OnProcessorTimeOfTheProcessAllThreadsCount) {
  const auto id = Armed({.clock = TimerClock::kProcessCpu, .is_posix = 1, .signal = SIGUSR1},
                        10 * kMs, 10 * kMs);
  EXPECT_TRUE(timers_.HasCpuTimers());
  EXPECT_EQ(timers_.NextExpiry(), kNeverNs);
  EXPECT_EQ(timers_.CpuTimeToExpiry({4 * kMs, kThread, kMs}), 6 * kMs);
  EXPECT_TRUE(timers_.ExpireCpu({9 * kMs, kThread, kMs}).empty());
  const auto ran_out = timers_.ExpireCpu({35 * kMs, kThread, kMs});
  ASSERT_EQ(ran_out.size(), 1u);
  EXPECT_EQ(ran_out[0].id, id);
  EXPECT_EQ(ran_out[0].count, 3);
  EXPECT_EQ(timers_.TakeSignals().at(0).overruns, 2);
  EXPECT_EQ(timers_.CpuTimeToExpiry({35 * kMs, kThread, kMs}), 5 * kMs);
  // Time that passes does not concern it.
  EXPECT_TRUE(timers_.Expire(1'000 * kMs).empty());
}

TEST_F(ProcessTimersTest, OnProcessorTimeOfAThreadOnlyThatOneCounts) {
  Armed({.clock = TimerClock::kThreadCpu, .clock_tid = kThread}, 10 * kMs);
  EXPECT_EQ(timers_.CpuTimeToExpiry({50 * kMs, kThread + 1, 50 * kMs}), kNeverNs);
  EXPECT_TRUE(timers_.ExpireCpu({50 * kMs, kThread + 1, 50 * kMs}).empty());
  EXPECT_EQ(timers_.CpuTimeToExpiry({50 * kMs, kThread, 3 * kMs}), 7 * kMs);
  EXPECT_EQ(timers_.ExpireCpu({50 * kMs, kThread, 10 * kMs}).size(), 1u);
  EXPECT_FALSE(timers_.HasCpuTimers());
}

TEST_F(ProcessTimersTest, WhatHasRunOutOnProcessorTimeIsFoundAtTheNextLook) {
  Armed({.clock = TimerClock::kProcessCpu}, 10 * kMs);
  EXPECT_EQ(timers_.CpuTimeToExpiry({30 * kMs, kThread, 0}), 1'000);
}

TEST_F(ProcessTimersTest, ShortIntervalsOfProcessorTimeAreLookedAtNowAndThen) {
  Armed({.clock = TimerClock::kProcessCpu}, kMs, 1'000);
  EXPECT_EQ(timers_.CpuTimeToExpiry({0, kThread, 0}), kMs);
  EXPECT_EQ(timers_.ExpireCpu({kMs, kThread, 0}).at(0).count, 1);
  EXPECT_EQ(timers_.CpuTimeToExpiry({kMs, kThread, 0}), shm::kShortIntervalNs);
  EXPECT_EQ(timers_.ExpireCpu({kMs + shm::kShortIntervalNs, kThread, 0}).at(0).count, 100);
}

// Short intervals.

TEST_F(ProcessTimersTest, OfAShortIntervalItRestsUntilItsProcessHasRun) {
  const auto id = Armed(kDescriptor, kMs, 1'000);
  EXPECT_EQ(timers_.NextExpiry(), kMs);
  EXPECT_EQ(CountAt(id, kMs), 1);
  EXPECT_EQ(timers_.NextExpiry(), kNeverNs);
  EXPECT_EQ(timers_.NextLook(), kMs + shm::kShortIntervalNs);
  timers_.EndRests(5 * kMs);
  EXPECT_EQ(timers_.NextLook(), kNeverNs);
  EXPECT_EQ(timers_.NextExpiry(), 5 * kMs);
  EXPECT_EQ(CountAt(id, 5 * kMs), 4'000);
}

TEST_F(ProcessTimersTest, WhoeverIsToSeeATimerThatRestsIsToldThatItIsBehind) {
  const auto id = Armed(kDescriptor, kMs, 1'000), other = Armed(kDescriptor, kMs, kMs);
  EXPECT_FALSE(timers_.IsBehind(id, kMs - 1));
  EXPECT_TRUE(timers_.IsBehind(id, kMs));
  EXPECT_FALSE(timers_.IsBehind(other, kMs));  // is fired at its instant
  timers_.Expire(kMs);
  EXPECT_FALSE(timers_.IsBehind(id, kMs + 999));
  EXPECT_TRUE(timers_.IsBehind(id, kMs + 1'000));
  timers_.Set(id, {0, 1'000}, {});
  EXPECT_FALSE(timers_.IsBehind(id, 2 * kMs));
}

TEST_F(ProcessTimersTest, OthersDoNotRest) {
  Armed(kDescriptor, kMs, shm::kShortIntervalNs);
  timers_.Expire(kMs);
  EXPECT_EQ(timers_.NextExpiry(), kMs + shm::kShortIntervalNs);
  EXPECT_EQ(timers_.NextLook(), kNeverNs);
  timers_.EndRests(9 * kMs);  // nobody does
  EXPECT_EQ(timers_.NextExpiry(), kMs + shm::kShortIntervalNs);
}

TEST_F(ProcessTimersTest, SetAnewItRestsNoMore) {
  const auto id = Armed(kDescriptor, kMs, 1'000);
  timers_.Expire(kMs);
  timers_.Set(id, {2 * kMs, 0}, {});
  EXPECT_EQ(timers_.NextExpiry(), 2 * kMs);
  EXPECT_EQ(timers_.NextLook(), kNeverNs);
}

// Where the process's clock is ahead of its virtual CPU's.

TEST_F(ProcessTimersTest, AFrozenClockIsAheadByWhatItWasWhenTheTimerWasSet) {
  const auto id = timers_.Create(kDescriptor);
  timers_.Set(id, {10 * kMs, 10 * kMs}, VirtualDuration::Nanoseconds(3 * kMs));
  EXPECT_EQ(timers_.NextExpiry(), 7 * kMs);
  EXPECT_TRUE(timers_.Expire(7 * kMs - 1).empty());
  const auto ran_out = timers_.Expire(7 * kMs);
  ASSERT_EQ(ran_out.size(), 1u);
  EXPECT_EQ(ran_out[0].clock_ns, 10 * kMs);
  EXPECT_EQ(timers_.NextExpiry(), 17 * kMs);
  EXPECT_EQ(timers_.Get(id).next_ns, 20 * kMs);
}

TEST_F(ProcessTimersTest, AFrozenClockDoesNotBringTheEndOfAllTimeNearer) {
  const auto id = timers_.Create(kDescriptor);
  timers_.Set(id, {kNeverNs, 0}, VirtualDuration::Nanoseconds(3 * kMs));
  EXPECT_EQ(timers_.NextExpiry(), kNeverNs);
}

TEST_F(ProcessTimersTest, OnAFrozenClockShortIntervalsRestAndAreAcceptedByItsTime) {
  const auto id = timers_.Create(kPosix);
  timers_.Set(id, {10 * kMs, 1'000}, VirtualDuration::Nanoseconds(3 * kMs));
  timers_.Expire(7 * kMs);
  EXPECT_EQ(timers_.NextLook(), 7 * kMs + shm::kShortIntervalNs);
  SendAll();
  timers_.AcceptAt(id, 8 * kMs);
  EXPECT_EQ(timers_.Overruns(id), 1'000);
}

}  // namespace
}  // namespace tcs
