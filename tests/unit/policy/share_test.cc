#include "coordinator/policy/share.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "coordinator/policy/run_queue.h"

namespace tcs {
namespace {

constexpr std::int64_t kTurnNs = 1'000'000;

TEST(Share, WhoHasHadNothingAndWaitedForNothingDoesNotGoFirst) {
  EXPECT_FALSE(Share{}.GoesFirst());
}

TEST(Share, WhoeverSleepsIsOwedItsPartOfWhatTheOthersUse) {
  Share sleeper;
  sleeper.Earn(900, 3);
  EXPECT_EQ(sleeper.owed_ns(), 300);
  EXPECT_TRUE(sleeper.GoesFirst());
}

TEST(Share, ItIsKnownHowMuchOfTheOthersUseItTakesUntilItGoesFirst) {
  Share waiting;
  waiting.Spend(600);
  const std::int64_t ns = waiting.NsUntilFirst(3);
  EXPECT_FALSE(waiting.GoesFirst(ns - 1, 3));
  EXPECT_TRUE(waiting.GoesFirst(ns, 3));
  waiting.Earn(ns, 3);
  EXPECT_EQ(waiting.NsUntilFirst(3), 0);
}

TEST(Share, WhoRunsAloneStaysEven) {
  Share alone;
  for (int i = 0; i < 100; ++i) {
    alone.Earn(kTurnNs, 1);
    alone.Spend(kTurnNs);
  }
  EXPECT_EQ(alone.owed_ns(), 0);
}

TEST(Share, WhoHasUsedMoreThanItsShareGoesFirstOnceTheOthersHaveMadeUpForIt) {
  Share greedy;
  greedy.Earn(kTurnNs, 2);
  greedy.Spend(kTurnNs);
  EXPECT_FALSE(greedy.GoesFirst());
  EXPECT_FALSE(greedy.GoesFirst(kTurnNs, 2));
  EXPECT_TRUE(greedy.GoesFirst(kTurnNs + 2, 2));
}

TEST(Share, AnHourOfSleepBuysOneTurnAndAnHourOfUseIsForgottenAsSoon) {
  Share share;
  share.Earn(3'600'000'000'000, 1);
  EXPECT_EQ(share.owed_ns(), Share::kMostNs);
  share.Spend(3'600'000'000'000);
  EXPECT_EQ(share.owed_ns(), -Share::kMostNs);
}

// One core, as the engine has it: threads that compute for so long and then sleep for so long.
class Core {
 public:
  struct Thread {
    std::int64_t computes_ns, sleeps_ns;
    std::int64_t left_ns = 0, due_ns = 0, turn_ns = 0, used_ns = 0, latest_ns = 0;
    Share share;
  };

  explicit Core(std::vector<Thread> threads) : threads_(std::move(threads)) {}

  void Run(std::int64_t until_ns) {
    while (now_ns_ < until_ns) {
      Wake();
      robot_.Assign({RobotTime(now_ns_)});
      const int running = robot_.Next(0).thread;
      if (running == RunQueue::kNobody) {
        ++now_ns_;
        continue;
      }
      Step(threads_[static_cast<std::size_t>(running)], running);
    }
  }
  const Thread& operator[](std::size_t i) const { return threads_[i]; }

 private:
  static constexpr int kPriority = 10;
  static constexpr std::int64_t kStepNs = 1'000;

  void Wake() {
    for (std::size_t i = 0; i < threads_.size(); ++i) {
      Thread& thread = threads_[i];
      if (robot_.IsReady(static_cast<int>(i)) || thread.due_ns > now_ns_) continue;
      thread.left_ns = thread.computes_ns;
      thread.turn_ns = 0;
      robot_.Add({static_cast<int>(i), kPriority, RobotTime(now_ns_), RunQueue::kEveryCore,
                  thread.share.GoesFirst()});
    }
  }

  void Step(Thread& thread, int number) {
    if (thread.left_ns == thread.computes_ns) {
      thread.latest_ns = std::max(thread.latest_ns, now_ns_ - thread.due_ns);
    }
    const std::int64_t ran = std::min(kStepNs, thread.left_ns);
    for (Thread& other : threads_) other.share.Earn(ran, robot_.CountOf(kPriority));
    thread.share.Spend(ran);
    now_ns_ += ran;
    thread.used_ns += ran;
    thread.turn_ns += ran;
    thread.left_ns -= ran;
    if (thread.left_ns == 0) {
      thread.due_ns = now_ns_ + thread.sleeps_ns;
      robot_.Remove(number);
    } else if (thread.turn_ns >= kTurnNs) {
      thread.turn_ns = 0;
      robot_.Rotate(number);
    }
  }

  RunQueue robot_{1};
  std::vector<Thread> threads_;
  std::int64_t now_ns_ = 0;
};

constexpr std::int64_t kForEver = INT64_MAX / 2;

TEST(Share, AClockThreadWakesOnTimeBesideFourThatCompute) {
  Core core({{.computes_ns = 5'000, .sleeps_ns = kTurnNs},
             {.computes_ns = kForEver, .sleeps_ns = 1},
             {.computes_ns = kForEver, .sleeps_ns = 1},
             {.computes_ns = kForEver, .sleeps_ns = 1},
             {.computes_ns = kForEver, .sleeps_ns = 1}});
  core.Run(100'000'000);
  EXPECT_LE(core[0].latest_ns, 1'000);
  EXPECT_NEAR(static_cast<double>(core[0].used_ns), 99.5 * 5'000, 5'000);
  for (std::size_t i = 1; i < 5; ++i) {
    EXPECT_NEAR(static_cast<double>(core[i].used_ns), 24.9e6, 1.1e6) << i;
  }
}

TEST(Share, ShortPausesBetweenLongComputationsStarveNobody) {
  for (const std::int64_t computes : {100'000, 400'000, 999'000, 1'000'000, 3'000'000}) {
    Core core(
        {{.computes_ns = computes, .sleeps_ns = 1'000}, {.computes_ns = kForEver, .sleeps_ns = 1}});
    core.Run(200'000'000);
    EXPECT_NEAR(static_cast<double>(core[0].used_ns), 100e6, 4e6) << computes;
  }
}

TEST(Share, ManyWhoPauseLeaveTheirPartToOneWhoDoesNot) {
  Core core({{.computes_ns = kForEver, .sleeps_ns = 1},
             {.computes_ns = 300'000, .sleeps_ns = 10'000},
             {.computes_ns = 500'000, .sleeps_ns = 10'000},
             {.computes_ns = 700'000, .sleeps_ns = 10'000}});
  core.Run(400'000'000);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(static_cast<double>(core[i].used_ns), 100e6, 15e6) << i;
  }
}

}  // namespace
}  // namespace tcs
