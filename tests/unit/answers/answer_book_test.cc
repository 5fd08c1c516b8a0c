#include "coordinator/answers/answer_book.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace tcs {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr AnswerBook::Who kController{.client = 0, .thread = 1};
constexpr AnswerBook::Who kPlanner{.client = 1, .thread = 2};

// A controller and a planner on one core.
class AnswerBookTest : public testing::Test {
 protected:
  void Open(std::int64_t deadline_ns = 0, bool is_periodic = true) {
    book_.Open({{.name = "controller", .deadline_ns = deadline_ns, .is_periodic = is_periodic},
                {.name = "planner"}},
               {"sensors"});
  }
  // A sample of a sensor with a period of 10 ms.
  static AnswerBook::Taken SampleOf(std::int64_t at_ns, unsigned activation = 0) {
    return {.arrived_ns = at_ns,
            .sampled_ns = at_ns,
            .period_ns = 10 * kMs,
            .sensor = 0,
            .activation = activation};
  }
  void Ends(const AnswerBook::Who& who, ReleaseCause cause, std::int64_t release_ns,
            std::int64_t start_ns, std::int64_t end_ns, unsigned receipt = 0) {
    const Activation activation{.cause = cause, .release_ns = release_ns, .start_ns = start_ns};
    book_.Ended(who, activation, receipt, end_ns, end_ns - start_ns);
  }
  ClientFigures Controller() { return book_.Conclude(1000 * kMs).front(); }

  AnswerBook book_;
};

TEST_F(AnswerBookTest, ThePeriodOfTheSensorIsTheDeadline) {
  Open();
  for (const std::int64_t took : {4 * kMs, 10 * kMs, 11 * kMs, 12 * kMs, 3 * kMs}) {
    static std::int64_t at = 0;
    at += 100 * kMs;
    book_.Ready(kController, at);
    book_.Took(kController, SampleOf(at));
    Ends(kController, ReleaseCause::kInput, at, at, at + took);
    book_.Idles(kController.thread);
  }
  const ClientFigures figures = Controller();
  EXPECT_EQ(figures.deadline.deadline_ns, 10 * kMs);
  EXPECT_EQ(figures.deadline.source, "sensors");
  EXPECT_EQ(figures.deadline.judged, 5);
  EXPECT_EQ(figures.deadline.missed, 2);
  EXPECT_EQ(figures.deadline.most_in_a_row, 2);
  EXPECT_EQ(figures.deadline.first_missed_ns, 300 * kMs);
  EXPECT_EQ(figures.times.response.max(), 12 * kMs);
  EXPECT_EQ(figures.late.total_ns, 23 * kMs);
  EXPECT_EQ(figures.late.executed_ns, 23 * kMs);
}

TEST_F(AnswerBookTest, WhatWaitedInTheSocketWasReleasedWhenItArrived) {
  Open();
  book_.Ready(kController, 0);
  book_.Took(kController, SampleOf(0));
  book_.Took(kController, SampleOf(10 * kMs, 1));
  book_.Took(kController, SampleOf(20 * kMs, 2));
  EXPECT_EQ(book_.ReleaseOf(kController.thread, 1, 15 * kMs), 10 * kMs);
  EXPECT_EQ(book_.ReleaseOf(kController.thread, 2, 30 * kMs), 20 * kMs);
  Ends(kController, ReleaseCause::kInput, 0, 0, 15 * kMs);
  Ends(kController, ReleaseCause::kInput, 10 * kMs, 15 * kMs, 30 * kMs, 1);
  book_.ForgetReceipts(kController.thread, 2);
  // Nothing more is known of receipts; the third goes on.
  EXPECT_EQ(book_.ReleaseOf(kController.thread, 1, 15 * kMs), 15 * kMs);
  Ends(kController, ReleaseCause::kInput, 20 * kMs, 30 * kMs, 45 * kMs);
  const ClientFigures figures = Controller();
  EXPECT_EQ(figures.deadline.judged, 3);
  EXPECT_EQ(figures.times.response.Quantile(0.3), 15 * kMs);
  EXPECT_EQ(figures.times.response.Quantile(0.5), 20 * kMs);
  EXPECT_EQ(figures.times.response.max(), 25 * kMs);
  EXPECT_EQ(figures.times.start_delay.max(), 10 * kMs);
  EXPECT_EQ(figures.late.queued_ns, 5 * kMs + 10 * kMs);
  EXPECT_EQ(figures.late.total_ns, figures.late.queued_ns + figures.late.executed_ns);
}

TEST_F(AnswerBookTest, ATimersDeadlineIsItsNextExpiry) {
  Open();
  Ends(kController, ReleaseCause::kTime, 0, 0, 4 * kMs);
  Ends(kController, ReleaseCause::kTime, 10 * kMs, 10 * kMs, 25 * kMs);
  Ends(kController, ReleaseCause::kTime, 20 * kMs, 25 * kMs, 31 * kMs);
  EXPECT_EQ(Controller().deadline.missed, 2);
  const ClientFigures figures = Controller();
  EXPECT_EQ(figures.deadline.deadline_ns, 10 * kMs);
  EXPECT_EQ(figures.deadline.judged, 3);
  EXPECT_EQ(figures.deadline.source, "its timer");
}

// 15 ms of computing: of each second expiry it learns with the next one.
TEST_F(AnswerBookTest, ATimersPeriodIsTheShortestOfThoseThatAreFrequent) {
  Open();
  std::int64_t end = 0;
  for (const std::int64_t release : {0, 10, 30, 40, 60, 80, 90, 110, 130}) {
    end = std::max(end, release * kMs);
    Ends(kController, ReleaseCause::kTime, release * kMs, end, end + 15 * kMs);
    end += 15 * kMs;
  }
  EXPECT_EQ(Controller().deadline.deadline_ns, 10 * kMs);
}

TEST_F(AnswerBookTest, TheClientsOwnDeadlineGoesFirst) {
  Open(2 * kMs, false);
  book_.Took(kController, SampleOf(0));
  Ends(kController, ReleaseCause::kInput, 0, kMs, 3 * kMs);
  const ClientFigures figures = Controller();
  EXPECT_EQ(figures.deadline.deadline_ns, 2 * kMs);
  EXPECT_EQ(figures.deadline.source, "");
  EXPECT_EQ(figures.deadline.missed, 1);
}

TEST_F(AnswerBookTest, APlannerHasNoneUnlessItsCommandsReachAnActuator) {
  Open(0, false);
  book_.Took(kController, SampleOf(0));
  Ends(kController, ReleaseCause::kInput, 0, 0, 50 * kMs);
  EXPECT_EQ(Controller().deadline.deadline_ns, 0);
  EXPECT_EQ(Controller().deadline.judged, 0);
  EXPECT_EQ(Controller().times.response.max(), 50 * kMs);
  book_.Commanded(kController, 50 * kMs);
  EXPECT_EQ(Controller().deadline.deadline_ns, 10 * kMs);
  EXPECT_EQ(Controller().deadline.missed, 1);
}

TEST_F(AnswerBookTest, ACommandIsAsOldAsTheNewestSampleOfItsSender) {
  Open();
  book_.Took(kController, SampleOf(30 * kMs));
  book_.Took(kController, SampleOf(20 * kMs));
  EXPECT_EQ(book_.LastSampledOf(kController.thread), 30 * kMs);
  book_.Commanded(kController, 37 * kMs);
  EXPECT_EQ(Controller().command_age.count(), 1);
  EXPECT_EQ(Controller().command_age.max(), 7 * kMs);
}

TEST_F(AnswerBookTest, OthersThatHadTheCoreAreNamed) {
  Open();
  book_.Ready(kController, 10 * kMs);
  book_.Took(kController, SampleOf(10 * kMs));
  book_.Ran(kPlanner, 0, 5 * kMs, 18 * kMs);
  book_.Ran(kController, 0, 18 * kMs, 20 * kMs);
  book_.Ran(kPlanner, 0, 20 * kMs, 22 * kMs);
  book_.Ran(kController, 0, 22 * kMs, 23 * kMs);
  const Activation activation{
      .cause = ReleaseCause::kInput, .release_ns = 10 * kMs, .start_ns = 18 * kMs};
  book_.Ended(kController, activation, 0, 23 * kMs, 3 * kMs);
  book_.Ran(kPlanner, 0, 23 * kMs, 30 * kMs);
  const ClientFigures figures = Controller();
  EXPECT_EQ(figures.late.total_ns, 13 * kMs);
  EXPECT_EQ(figures.late.executed_ns, 3 * kMs);
  EXPECT_EQ(figures.late.others_ns.at("planner"), 10 * kMs);
  EXPECT_EQ(figures.longest_wait.waited_ns, 10 * kMs);
  EXPECT_EQ(figures.longest_wait.by, "planner");
}

TEST_F(AnswerBookTest, WithMoreCoresThoseBesideItKeepItFromNothing) {
  Open();
  book_.Ready(kController, 0);
  book_.Ran(kController, 0, 0, kMs);
  book_.Ran(kPlanner, 0, 0, 20 * kMs);
  book_.Took(kController, SampleOf(0));
  Ends(kController, ReleaseCause::kInput, 0, 0, 20 * kMs);
  EXPECT_TRUE(Controller().late.others_ns.empty());
}

TEST_F(AnswerBookTest, ThreadsThatOnlyHelpAreNotJudged) {
  Open();
  const AnswerBook::Who helper{.client = 0, .thread = 7, .is_first = false};
  Ends(helper, ReleaseCause::kTime, 0, 0, kMs);
  Ends(helper, ReleaseCause::kTime, 2 * kMs, 2 * kMs, 50 * kMs);
  EXPECT_EQ(Controller().deadline.judged, 0);
  EXPECT_EQ(Controller().times.response.count(), 0);
}

TEST_F(AnswerBookTest, WhatNobodyCameToCountsAsItStands) {
  Open();
  book_.NeverCameTo(kController, SampleOf(20 * kMs), 100 * kMs);
  const ClientFigures figures = Controller();
  EXPECT_EQ(figures.deadline.missed, 1);
  EXPECT_EQ(figures.times.response.max(), 80 * kMs);
  EXPECT_EQ(figures.times.execution.max(), 0);
}

// It computes 2 ms, waits 5 ms for a lock of the planner's, which then has the core for 1 ms more,
// and computes 3 ms.
TEST_F(AnswerBookTest, AWaitForALockIsInTheMidstOfAnActivation) {
  Open();
  std::vector<Response> told;
  book_.Tell([&](const Response& response) { told.push_back(response); });
  book_.Ready(kController, 10 * kMs);
  book_.Took(kController, SampleOf(10 * kMs));
  book_.Ran(kController, 0, 10 * kMs, 12 * kMs);
  book_.Pauses(kController,
               {.cause = ReleaseCause::kInput, .release_ns = 10 * kMs, .start_ns = 10 * kMs}, 0,
               12 * kMs, 2 * kMs, {.what = AnswerBook::Pause::For::kLock, .client = 1});
  book_.Ran(kPlanner, 0, 12 * kMs, 17 * kMs);
  book_.Ready(kController, 17 * kMs);
  book_.Ran(kPlanner, 0, 17 * kMs, 18 * kMs);
  book_.Ran(kController, 0, 18 * kMs, 21 * kMs);
  const Activation rest{
      .cause = ReleaseCause::kThread, .release_ns = 17 * kMs, .start_ns = 18 * kMs};
  book_.Ended(kController, rest, 0, 21 * kMs, 3 * kMs);
  const ClientFigures figures = Controller();
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].TookNs(), 11 * kMs);
  EXPECT_EQ(told[0].deadline_ns, 10 * kMs);
  EXPECT_EQ(told[0].parts.executed_ns, 5 * kMs);
  EXPECT_EQ(told[0].parts.locks_ns, (ByClient{{1, 5 * kMs}}));
  EXPECT_EQ(told[0].parts.cores_ns, (ByClient{{1, kMs}}));
  EXPECT_EQ(told[0].RestNs(), 0);
  EXPECT_EQ(figures.deadline.missed, 1);
  EXPECT_EQ(figures.late.locks_ns.at("planner"), 5 * kMs);
}

TEST_F(AnswerBookTest, OneThatWaitsForALockAtTheEndCountsAsItStands) {
  Open();
  book_.Ready(kController, 10 * kMs);
  book_.Took(kController, SampleOf(10 * kMs));
  book_.Pauses(kController,
               {.cause = ReleaseCause::kInput, .release_ns = 10 * kMs, .start_ns = 10 * kMs}, 0,
               12 * kMs, 2 * kMs, {.what = AnswerBook::Pause::For::kLock, .client = 1});
  const ClientFigures figures = Controller();
  EXPECT_EQ(figures.deadline.missed, 1);
  EXPECT_EQ(figures.times.response.max(), 990 * kMs);
  EXPECT_EQ(figures.late.locks_ns.at("planner"), 988 * kMs);
}

TEST_F(AnswerBookTest, WhatItDidNotLookAtForItSleptIsApart) {
  Open();
  std::vector<Response> told;
  book_.Tell([&](const Response& response) { told.push_back(response); });
  book_.Took(kController, SampleOf(20 * kMs));
  book_.Ready(kController, 33 * kMs);
  Ends(kController, ReleaseCause::kInput, 20 * kMs, 34 * kMs, 36 * kMs);
  Controller();
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].parts.away_ns, 13 * kMs);
  EXPECT_EQ(told[0].parts.executed_ns, 2 * kMs);
  EXPECT_EQ(told[0].RestNs(), kMs);
}

// Of the time before its thread is ready, the last part is the kernel's.
TEST_F(AnswerBookTest, WakingAThreadIsAPartOfItsOwn) {
  Open();
  std::vector<Response> told;
  book_.Tell([&](const Response& response) { told.push_back(response); });
  book_.Took(kController, SampleOf(20 * kMs));
  book_.Ready(kController, 33 * kMs);
  book_.Ended(kController,
              {.cause = ReleaseCause::kInput,
               .release_ns = 20 * kMs,
               .wakeup_ns = 3 * kMs,
               .start_ns = 34 * kMs},
              0, 36 * kMs, 2 * kMs);
  EXPECT_EQ(Controller().late.wakeup_ns, 3 * kMs);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].parts.away_ns, 10 * kMs);
  EXPECT_EQ(told[0].parts.wakeup_ns, 3 * kMs);
  EXPECT_EQ(told[0].RestNs(), kMs);
}

}  // namespace
}  // namespace tcs
