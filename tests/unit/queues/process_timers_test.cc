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
    for (const auto& timer : timers_.Expire(RobotTime(now_ns)))
      count += timer.id == id ? timer.count : 0;
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
  EXPECT_EQ(timers_.NextExpiry(), VirtualTime::Never());
  EXPECT_EQ(timers_.NextLook(), VirtualTime::Never());
  EXPECT_FALSE(timers_.HasCpuTimers());
  EXPECT_FALSE(timers_.HasSignals());
  EXPECT_TRUE(timers_.Expire(RobotTime(1'000 * kMs)).empty());
}

TEST_F(ProcessTimersTest, WithoutIntervalItRunsOutOnce) {
  const auto id = Armed(kDescriptor, 5 * kMs);
  EXPECT_EQ(timers_.NextExpiry(), RobotTime(5 * kMs));
  EXPECT_EQ(CountAt(id, 5 * kMs - 1), 0);
  EXPECT_EQ(CountAt(id, 5 * kMs), 1);
  EXPECT_EQ(timers_.Get(id).next_ns, 0);
  EXPECT_EQ(timers_.NextExpiry(), VirtualTime::Never());
  EXPECT_EQ(CountAt(id, 100 * kMs), 0);
}

TEST_F(ProcessTimersTest, WithAnIntervalItRunsOutAgain) {
  const auto id = Armed(kDescriptor, 5 * kMs, 2 * kMs);
  const auto ran_out = timers_.Expire(RobotTime(5 * kMs));
  ASSERT_EQ(ran_out.size(), 1u);
  EXPECT_EQ(ran_out[0].id, id);
  EXPECT_EQ(ran_out[0].count, 1);
  EXPECT_EQ(ran_out[0].shown, OwnTime(5 * kMs));
  EXPECT_TRUE(ran_out[0].is_periodic);
  EXPECT_EQ(timers_.NextExpiry(), RobotTime(7 * kMs));
  EXPECT_EQ(CountAt(id, 7 * kMs), 1);
  EXPECT_EQ(timers_.NextExpiry(), RobotTime(9 * kMs));
}

TEST_F(ProcessTimersTest, WhoeverKeepsItsNextExpiryIsToldOfEachOtherOne) {
  std::vector<std::int64_t> told;
  timers_.TellOfNextExpiry([&] { told.push_back(timers_.NextExpiry().ns()); });
  const auto id = Armed(kDescriptor, 5 * kMs, 2 * kMs);
  const auto later = Armed(kDescriptor, 50 * kMs);
  timers_.Expire(RobotTime(5 * kMs));
  timers_.Delete(id);
  timers_.Set(later, {}, {});
  EXPECT_EQ(told, (std::vector<std::int64_t>{5 * kMs, 7 * kMs, 50 * kMs, kNeverNs}));
}

TEST_F(ProcessTimersTest, WhatRestsIsToldOfAsWell) {
  std::vector<std::int64_t> told;
  Armed(kDescriptor, 5 * kMs, 1'000);
  timers_.TellOfNextExpiry([&] { told.push_back(timers_.NextExpiry().ns()); });
  timers_.Expire(RobotTime(5 * kMs));
  timers_.EndRests(RobotTime(6 * kMs));
  EXPECT_EQ(told, (std::vector<std::int64_t>{kNeverNs, 6 * kMs}));
}

TEST_F(ProcessTimersTest, ManyIntervalsAreCaughtUpWithAtOnce) {
  const auto id = Armed(kDescriptor, 5 * kMs, 2 * kMs);
  EXPECT_EQ(CountAt(id, 5 * kMs + 2'000'000 * kMs + 1), 1'000'001);
  EXPECT_EQ(timers_.Get(id).next_ns, 5 * kMs + 2'000'002 * kMs);
}

TEST_F(ProcessTimersTest, TheEndOfAllTimeNeverComes) {
  const auto once = Armed(kDescriptor, kNeverNs);
  EXPECT_EQ(timers_.NextExpiry(), VirtualTime::Never());
  const auto often = Armed(kDescriptor, 1, kNeverNs);
  EXPECT_EQ(CountAt(often, kMs), 1);
  EXPECT_EQ(timers_.Get(often).next_ns, kNeverNs);
  EXPECT_EQ(timers_.NextExpiry(), VirtualTime::Never());
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
  EXPECT_EQ(timers_.NextExpiry(), RobotTime(20 * kMs));
  timers_.Set(id, {0, kMs}, {});  // not armed
  EXPECT_EQ(timers_.NextExpiry(), VirtualTime::Never());
  EXPECT_EQ(timers_.Get(id).interval_ns, kMs);
  timers_.Set(id, {-7, -7}, {});  // what no program asks for
  EXPECT_EQ(timers_.Get(id).next_ns, 0);
  EXPECT_EQ(timers_.Get(id).interval_ns, 0);
}

TEST_F(ProcessTimersTest, WhatIsNoTimerIsLeftAlone) {
  constexpr ProcessTimers::Id kNone = 77;
  timers_.Set(kNone, {kMs, kMs}, {});
  timers_.Delete(kNone);
  timers_.Accept(kNone, RobotTime(kMs));
  timers_.AcceptAt(kNone, RobotTime(kMs), false);
  EXPECT_FALSE(timers_.KindOf(kNone).has_value());
  EXPECT_EQ(timers_.Get(kNone).next_ns, 0);
  EXPECT_EQ(timers_.Overruns(kNone), 0);
  EXPECT_FALSE(timers_.IsBehind(kNone, RobotTime(kMs)));
  EXPECT_EQ(timers_.NextExpiry(), VirtualTime::Never());
}

TEST_F(ProcessTimersTest, TheThreeOfSetitimerAreThereWithoutBeingCreated) {
  EXPECT_EQ(timers_.KindOf(ITIMER_REAL)->signal, SIGALRM);
  EXPECT_EQ(timers_.KindOf(ITIMER_VIRTUAL)->signal, SIGVTALRM);
  EXPECT_EQ(timers_.KindOf(ITIMER_PROF)->signal, SIGPROF);
  EXPECT_EQ(timers_.KindOf(ITIMER_PROF)->clock, TimerClock::kProcessCpu);
  timers_.Set(ITIMER_REAL, {3 * kMs, 0}, {});
  EXPECT_EQ(timers_.NextExpiry(), RobotTime(3 * kMs));
  timers_.Delete(ITIMER_REAL);  // not for them
  EXPECT_EQ(CountAt(ITIMER_REAL, 3 * kMs), 1);
}

TEST_F(ProcessTimersTest, OneSignalOfSetitimersIsUnderwayAndNotCounted) {
  timers_.Set(ITIMER_REAL, {kMs, kMs}, {});
  timers_.Expire(RobotTime(5 * kMs));
  timers_.Expire(RobotTime(6 * kMs));
  const auto signals = timers_.TakeSignals();
  ASSERT_EQ(signals.size(), 1u);
  EXPECT_EQ(signals[0].number, SIGALRM);
  EXPECT_EQ(signals[0].timer_id, 0);
  EXPECT_EQ(signals[0].tid, 0);
  // Once sent, what is pending is the kernel's to tell.
  timers_.NoteSent(signals[0], 0);
  EXPECT_TRUE(timers_.SentSignals().empty());
  timers_.Expire(RobotTime(7 * kMs));
  EXPECT_TRUE(timers_.HasSignals());
}

TEST_F(ProcessTimersTest, SignalsAreInTheOrderOfTheirExpirationsAndCanBeGivenBack) {
  const auto first = Armed(kPosix, kMs), second = Armed(kPosix, 2 * kMs);
  timers_.Expire(RobotTime(kMs));
  timers_.Expire(RobotTime(2 * kMs));
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
  timers_.Expire(RobotTime(3 * kMs));
  const auto signals = timers_.TakeSignals();
  ASSERT_EQ(signals.size(), 1u);
  EXPECT_EQ(signals[0].overruns, 2);
  timers_.NoteSent(signals[0], kThread);
  timers_.Expire(RobotTime(7 * kMs));
  EXPECT_FALSE(timers_.HasSignals());
  EXPECT_EQ(timers_.Overruns(id), 0);  // none was accepted
  timers_.Accept(id, RobotTime(7 * kMs));
  EXPECT_EQ(timers_.Overruns(id), 6);
  // The next one is a signal of its own.
  timers_.Expire(RobotTime(8 * kMs));
  EXPECT_TRUE(timers_.HasSignals());
  EXPECT_EQ(timers_.Overruns(id), 6);
  timers_.Accept(id, RobotTime(8 * kMs));
  EXPECT_EQ(timers_.Overruns(id), 0);
}

TEST_F(ProcessTimersTest, OnlySentSignalsCanHaveBeenAccepted) {
  const auto id = Armed(kPosix, kMs, kMs);
  timers_.Expire(RobotTime(kMs));
  EXPECT_TRUE(timers_.SentSignals().empty());
  SendAll();
  const auto sent = timers_.SentSignals();
  ASSERT_EQ(sent.size(), 1u);
  EXPECT_EQ(sent[0].timer_id, id);
  EXPECT_EQ(sent[0].number, SIGUSR1);
  EXPECT_EQ(sent[0].to, kThread);
  timers_.Accept(id, RobotTime(kMs));
  EXPECT_TRUE(timers_.SentSignals().empty());
}

TEST_F(ProcessTimersTest, WhoAcceptsASignalHasAllThatHasRunOutByNow) {
  const auto id = Armed(kPosix, kMs, kMs);
  timers_.AcceptAt(id, RobotTime(9 * kMs), false);  // nothing is underway: nothing happens
  EXPECT_EQ(timers_.NextExpiry(), RobotTime(kMs));
  timers_.Expire(RobotTime(kMs));
  SendAll();
  timers_.AcceptAt(id, RobotTime(4 * kMs), false);
  EXPECT_EQ(timers_.Overruns(id), 3);
  EXPECT_EQ(timers_.NextExpiry(), RobotTime(5 * kMs));
}

// Between taking a signal and saying so a thread may be kept: the timer runs out, its signal is not
// pending any more, and the next one is sent.
TEST_F(ProcessTimersTest, WhoSaysLateWhatItAcceptedDoesNotAcceptTheNextOne) {
  const auto id = Armed(kPosix, kMs, kMs);
  timers_.Expire(RobotTime(9 * kMs));
  SendAll();
  timers_.Accept(id, RobotTime(10 * kMs));
  timers_.Expire(RobotTime(10 * kMs));
  SendAll();
  timers_.AcceptAt(id, RobotTime(10 * kMs), true);
  EXPECT_EQ(timers_.Overruns(id), 8);
  // It takes that one, too, and says so at once.
  timers_.AcceptAt(id, RobotTime(12 * kMs), false);
  EXPECT_EQ(timers_.Overruns(id), 2);
}

// A timer of a short interval rests while its thread sleeps. What it has run out meanwhile belongs
// to the signal that was pending, though the thread has not said that it took it.
TEST_F(ProcessTimersTest, WhatAShortOneRanOutMeanwhileIsOfTheSignalThatWasPending) {
  const auto id = Armed(kPosix, kMs, 1'000);
  timers_.Expire(RobotTime(kMs));
  SendAll();
  timers_.EndRests(RobotTime(9 * kMs));  // the thread runs again, and takes the signal
  timers_.Accept(id, RobotTime(9 * kMs));
  EXPECT_EQ(timers_.Overruns(id), 7'999);
  EXPECT_EQ(CountAt(id, 9 * kMs), 1);  // the one of this instant has a signal of its own
  EXPECT_TRUE(timers_.HasSignals());
  SendAll();
  timers_.AcceptAt(id, RobotTime(9 * kMs), true);  // it says so now, and of the first one
  EXPECT_EQ(timers_.Overruns(id), 7'999);
}

TEST_F(ProcessTimersTest, OverrunsAreNoMoreThanAnIntHolds) {
  const auto id = Armed(kPosix, 1, 1);
  timers_.Expire(RobotTime(1'000'000 * kMs));
  EXPECT_EQ(timers_.TakeSignals().at(0).overruns, INT_MAX);
  timers_.Expire(RobotTime(kNeverNs - 1));
  timers_.Accept(id, RobotTime(kNeverNs));
  EXPECT_EQ(timers_.Overruns(id), INT_MAX);
}

TEST_F(ProcessTimersTest, SetAnewItsOverrunsAreForgottenAndASignalUnderwayIsNot) {
  const auto id = Armed(kPosix, kMs, kMs);
  timers_.Expire(RobotTime(3 * kMs));
  timers_.Set(id, {10 * kMs, 0}, {});
  EXPECT_TRUE(timers_.HasSignals());
  SendAll();
  EXPECT_TRUE(timers_.SentSignals().empty());
  timers_.Accept(id, RobotTime(3 * kMs));
  EXPECT_EQ(timers_.Overruns(id), 0);
}

TEST_F(ProcessTimersTest, DeletedItsUnsentSignalIsGone) {
  const auto id = Armed(kPosix, kMs, kMs), other = Armed(kPosix, kMs);
  timers_.Expire(RobotTime(kMs));
  timers_.Delete(id);
  EXPECT_FALSE(timers_.KindOf(id).has_value());
  EXPECT_EQ(timers_.NextExpiry(), VirtualTime::Never());
  const auto signals = timers_.TakeSignals();
  ASSERT_EQ(signals.size(), 1u);
  EXPECT_EQ(signals[0].timer_id, other);
}

TEST_F(ProcessTimersTest, DeletedWithASentSignalNobodyWaitsForItsAcceptance) {
  const auto id = Armed(kPosix, kMs);
  timers_.Expire(RobotTime(kMs));
  const auto signals = timers_.TakeSignals();
  timers_.NoteSent(signals[0], kThread);
  timers_.Delete(id);
  EXPECT_TRUE(timers_.SentSignals().empty());
  timers_.Accept(id, RobotTime(kMs));
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
  EXPECT_EQ(timers_.NextExpiry(), RobotTime(2 * kMs));
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

TEST_F(ProcessTimersTest, OverrunsOfALostSignalAreNobodys) {
  const auto id = Armed(kPosix, 10 * kMs, 10 * kMs);
  timers_.Expire(RobotTime(35 * kMs));
  SendAll();
  timers_.Accept(id, RobotTime(35 * kMs));
  EXPECT_EQ(timers_.Overruns(id), 2);
  timers_.Expire(RobotTime(95 * kMs));
  SendAll();
  timers_.Lost(id);
  EXPECT_TRUE(timers_.SentSignals().empty());
  EXPECT_EQ(timers_.Overruns(id), 2);
  timers_.Expire(RobotTime(105 * kMs));
  EXPECT_TRUE(timers_.HasSignals());
}

TEST_F(ProcessTimersTest, WhatRunsOutAtADateMovesWithTheDate) {
  const auto at_date = timers_.Create(kDescriptor), in_time = Armed(kDescriptor, 50 * kMs);
  timers_.Set(at_date, {50 * kMs, 0, true}, {});
  timers_.MoveDates(-20 * kMs, RobotTime(kMs));
  EXPECT_EQ(timers_.Get(at_date).next_ns, 70 * kMs);
  EXPECT_EQ(timers_.Get(in_time).next_ns, 50 * kMs);
  EXPECT_EQ(timers_.NextExpiry(), RobotTime(50 * kMs));
  timers_.MoveDates(1'000 * kMs, RobotTime(2 * kMs));
  EXPECT_EQ(timers_.NextExpiry(), RobotTime(2 * kMs));  // not before it was set
  EXPECT_EQ(CountAt(at_date, 2 * kMs), 1);
  EXPECT_EQ(timers_.NextExpiry(), RobotTime(50 * kMs));
}

TEST_F(ProcessTimersTest, WhatRunsOutAtEachFullSecondDoesSoWhereverTheDateGoes) {
  const auto id = timers_.Create(kDescriptor);
  timers_.Set(id, {50 * kMs, 1'000 * kMs, true}, {});
  timers_.MoveDates(3'600'300 * kMs, RobotTime(20 * kMs));
  EXPECT_EQ(CountAt(id, 20 * kMs), 3601);
  EXPECT_EQ(timers_.NextExpiry(), RobotTime(750 * kMs));
}

// Processor time.

TEST_F(ProcessTimersTest, OnProcessorTimeOfTheProcessAllThreadsCount) {
  const auto id = Armed({.clock = TimerClock::kProcessCpu, .is_posix = 1, .signal = SIGUSR1},
                        10 * kMs, 10 * kMs);
  EXPECT_TRUE(timers_.HasCpuTimers());
  EXPECT_EQ(timers_.NextExpiry(), VirtualTime::Never());
  EXPECT_EQ(timers_.CpuTimeToExpiry({VirtualNs(4 * kMs), kThread, VirtualNs(kMs)}),
            VirtualNs(6 * kMs));
  EXPECT_TRUE(timers_.ExpireCpu({VirtualNs(9 * kMs), kThread, VirtualNs(kMs)}).empty());
  const auto ran_out = timers_.ExpireCpu({VirtualNs(35 * kMs), kThread, VirtualNs(kMs)});
  ASSERT_EQ(ran_out.size(), 1u);
  EXPECT_EQ(ran_out[0].id, id);
  EXPECT_EQ(ran_out[0].count, 3);
  const std::vector<TimerSignal> signals = timers_.TakeSignals();
  ASSERT_EQ(signals.size(), 1u);
  EXPECT_EQ(signals[0].overruns, 2);
  EXPECT_EQ(signals[0].computed, kThread);
  EXPECT_EQ(timers_.CpuTimeToExpiry({VirtualNs(35 * kMs), kThread, VirtualNs(kMs)}),
            VirtualNs(5 * kMs));
  // Time that passes does not concern it.
  EXPECT_TRUE(timers_.Expire(RobotTime(1'000 * kMs)).empty());
}

TEST_F(ProcessTimersTest, OnProcessorTimeOfAThreadOnlyThatOneCounts) {
  Armed({.clock = TimerClock::kThreadCpu, .clock_tid = kThread}, 10 * kMs);
  EXPECT_EQ(timers_.CpuTimeToExpiry({VirtualNs(50 * kMs), kThread + 1, VirtualNs(50 * kMs)}),
            std::nullopt);
  EXPECT_TRUE(timers_.ExpireCpu({VirtualNs(50 * kMs), kThread + 1, VirtualNs(50 * kMs)}).empty());
  EXPECT_EQ(timers_.CpuTimeToExpiry({VirtualNs(50 * kMs), kThread, VirtualNs(3 * kMs)}),
            VirtualNs(7 * kMs));
  EXPECT_EQ(timers_.ExpireCpu({VirtualNs(50 * kMs), kThread, VirtualNs(10 * kMs)}).size(), 1u);
  EXPECT_FALSE(timers_.HasCpuTimers());
}

TEST_F(ProcessTimersTest, WhatHasRunOutOnProcessorTimeIsFoundAtTheNextLook) {
  Armed({.clock = TimerClock::kProcessCpu}, 10 * kMs);
  EXPECT_EQ(timers_.CpuTimeToExpiry({VirtualNs(30 * kMs), kThread, VirtualNs(0)}),
            VirtualNs(1'000));
}

TEST_F(ProcessTimersTest, ShortIntervalsOfProcessorTimeAreLookedAtNowAndThen) {
  Armed({.clock = TimerClock::kProcessCpu}, kMs, 1'000);
  EXPECT_EQ(timers_.CpuTimeToExpiry({VirtualNs(0), kThread, VirtualNs(0)}), VirtualNs(kMs));
  EXPECT_EQ(timers_.ExpireCpu({VirtualNs(kMs), kThread, VirtualNs(0)}).at(0).count, 1);
  EXPECT_EQ(timers_.CpuTimeToExpiry({VirtualNs(kMs), kThread, VirtualNs(0)}),
            VirtualNs(shm::kShortIntervalNs));
  EXPECT_EQ(timers_.ExpireCpu({VirtualNs(kMs + shm::kShortIntervalNs), kThread, VirtualNs(0)})
                .at(0)
                .count,
            100);
}

// Short intervals.

TEST_F(ProcessTimersTest, OfAShortIntervalItRestsUntilItsProcessHasRun) {
  const auto id = Armed(kDescriptor, kMs, 1'000);
  EXPECT_EQ(timers_.NextExpiry(), RobotTime(kMs));
  EXPECT_EQ(CountAt(id, kMs), 1);
  EXPECT_EQ(timers_.NextExpiry(), VirtualTime::Never());
  EXPECT_EQ(timers_.NextLook(), RobotTime(kMs + shm::kShortIntervalNs));
  timers_.EndRests(RobotTime(5 * kMs));
  EXPECT_EQ(timers_.NextLook(), VirtualTime::Never());
  EXPECT_EQ(timers_.NextExpiry(), RobotTime(5 * kMs));
  EXPECT_EQ(CountAt(id, 5 * kMs), 4'000);
}

TEST_F(ProcessTimersTest, WhoeverIsToSeeATimerThatRestsIsToldThatItIsBehind) {
  const auto id = Armed(kDescriptor, kMs, 1'000), other = Armed(kDescriptor, kMs, kMs);
  EXPECT_FALSE(timers_.IsBehind(id, RobotTime(kMs - 1)));
  EXPECT_TRUE(timers_.IsBehind(id, RobotTime(kMs)));
  EXPECT_FALSE(timers_.IsBehind(other, RobotTime(kMs)));  // is fired at its instant
  timers_.Expire(RobotTime(kMs));
  EXPECT_FALSE(timers_.IsBehind(id, RobotTime(kMs + 999)));
  EXPECT_TRUE(timers_.IsBehind(id, RobotTime(kMs + 1'000)));
  timers_.Set(id, {0, 1'000}, {});
  EXPECT_FALSE(timers_.IsBehind(id, RobotTime(2 * kMs)));
}

TEST_F(ProcessTimersTest, OthersDoNotRest) {
  Armed(kDescriptor, kMs, shm::kShortIntervalNs);
  timers_.Expire(RobotTime(kMs));
  EXPECT_EQ(timers_.NextExpiry(), RobotTime(kMs + shm::kShortIntervalNs));
  EXPECT_EQ(timers_.NextLook(), VirtualTime::Never());
  timers_.EndRests(RobotTime(9 * kMs));  // nobody does
  EXPECT_EQ(timers_.NextExpiry(), RobotTime(kMs + shm::kShortIntervalNs));
}

TEST_F(ProcessTimersTest, SetAnewItRestsNoMore) {
  const auto id = Armed(kDescriptor, kMs, 1'000);
  timers_.Expire(RobotTime(kMs));
  timers_.Set(id, {2 * kMs, 0}, {});
  EXPECT_EQ(timers_.NextExpiry(), RobotTime(2 * kMs));
  EXPECT_EQ(timers_.NextLook(), VirtualTime::Never());
}

// Where the process's clock is ahead of its virtual CPU's.

TEST_F(ProcessTimersTest, AFrozenClockIsAheadByWhatItWasWhenTheTimerWasSet) {
  const auto id = timers_.Create(kDescriptor);
  timers_.Set(id, {10 * kMs, 10 * kMs}, VirtualDuration::Nanoseconds(3 * kMs));
  EXPECT_EQ(timers_.NextExpiry(), RobotTime(7 * kMs));
  EXPECT_TRUE(timers_.Expire(RobotTime(7 * kMs - 1)).empty());
  const auto ran_out = timers_.Expire(RobotTime(7 * kMs));
  ASSERT_EQ(ran_out.size(), 1u);
  EXPECT_EQ(ran_out[0].shown, OwnTime(10 * kMs));
  EXPECT_EQ(timers_.NextExpiry(), RobotTime(17 * kMs));
  EXPECT_EQ(timers_.Get(id).next_ns, 20 * kMs);
}

TEST_F(ProcessTimersTest, AFrozenClockDoesNotBringTheEndOfAllTimeNearer) {
  const auto id = timers_.Create(kDescriptor);
  timers_.Set(id, {kNeverNs, 0}, VirtualDuration::Nanoseconds(3 * kMs));
  EXPECT_EQ(timers_.NextExpiry(), VirtualTime::Never());
}

TEST_F(ProcessTimersTest, OnAFrozenClockShortIntervalsRestAndAreAcceptedByItsTime) {
  const auto id = timers_.Create(kPosix);
  timers_.Set(id, {10 * kMs, 1'000}, VirtualDuration::Nanoseconds(3 * kMs));
  timers_.Expire(RobotTime(7 * kMs));
  EXPECT_EQ(timers_.NextLook(), RobotTime(7 * kMs + shm::kShortIntervalNs));
  SendAll();
  timers_.AcceptAt(id, RobotTime(8 * kMs), false);
  EXPECT_EQ(timers_.Overruns(id), 1'000);
}

}  // namespace
}  // namespace tcs
