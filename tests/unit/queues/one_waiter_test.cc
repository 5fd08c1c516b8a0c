#include "coordinator/queues/one_waiter.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace tcs {
namespace {

// Threads by number; those of one tens place wait for the same descriptor.
bool IsOneEvent(int first, int second) { return first / 10 == second / 10; }

EventWaiter Taking(int thread, std::uint64_t order) {
  return {.thread = thread, .takes = true, .order = order};
}

// Whom each is passed over for, by thread.
std::map<int, int> Shares(std::vector<EventWaiter> waiters) {
  std::map<int, int> shares;
  for (const EventShare& share : ShareEvents(std::move(waiters), IsOneEvent)) {
    shares[share.thread] = share.passed_over_for;
  }
  return shares;
}

TEST(ShareEvents, WakesTheOneThatWaitsLongest) {
  EXPECT_EQ(Shares({Taking(12, 3), Taking(11, 1), Taking(13, 2)}),
            (std::map<int, int>{{11, kNoThread}, {12, 11}, {13, 11}}));
}

TEST(ShareEvents, WakesTheLastThatCameWhereItIsFirst) {
  const auto in_set = [](int thread, std::uint64_t order) {
    return EventWaiter{.thread = thread, .takes = true, .last_is_first = true, .order = order};
  };
  EXPECT_EQ(Shares({in_set(11, 1), in_set(12, 2)}),
            (std::map<int, int>{{12, kNoThread}, {11, 12}}));
}

TEST(ShareEvents, WakesAllThatDoNotTake) {
  EXPECT_EQ(Shares({{.thread = 11, .order = 1}, {.thread = 12, .order = 2}, Taking(13, 3)}),
            (std::map<int, int>{{11, kNoThread}, {12, kNoThread}, {13, kNoThread}}));
}

TEST(ShareEvents, WakesOneForEachDescriptor) {
  EXPECT_EQ(Shares({Taking(11, 1), Taking(21, 2), Taking(12, 3), Taking(22, 4)}),
            (std::map<int, int>{{11, kNoThread}, {21, kNoThread}, {12, 11}, {22, 21}}));
}

// Of a fleet each waits at a socket of its own.
TEST(ShareEvents, NobodyIsAskedAboutThoseWhoWaitAtDifferentPlaces) {
  std::vector<EventWaiter> waiters;
  for (int thread = 0; thread < 500; ++thread) {
    waiters.push_back(Taking(thread, 1000 - static_cast<std::uint64_t>(thread)));
    waiters.back().place = static_cast<std::uint64_t>(thread / 2);
  }
  int asked = 0;
  const auto shares = ShareEvents(std::move(waiters), [&asked](int first, int second) {
    ++asked;
    return first / 2 == second / 2;
  });
  EXPECT_EQ(asked, 250);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    EXPECT_EQ(shares[i].thread, 499 - static_cast<int>(i));
    EXPECT_EQ(shares[i].passed_over_for, i % 2 == 0 ? kNoThread : shares[i].thread + 1);
  }
}

TEST(ShareEvents, ThoseThatAreWokenAreInTheOrderOfWaiting) {
  const auto shares = ShareEvents({Taking(21, 2), Taking(31, 3), Taking(11, 1)}, IsOneEvent);
  ASSERT_EQ(shares.size(), 3u);
  EXPECT_EQ(shares[0].thread, 11);
  EXPECT_EQ(shares[1].thread, 21);
  EXPECT_EQ(shares[2].thread, 31);
}

class PassRestOnTest : public testing::Test {
 protected:
  Rest Pass(const std::set<int>& with_events) const {
    return PassRestOn({Taking(13, 3), Taking(11, 1), Taking(12, 2)},
                      [&](int thread) { return with_events.contains(thread); });
  }
};

TEST_F(PassRestOnTest, NobodyIsNextIfNothingIsLeft) {
  const Rest rest = Pass({});
  EXPECT_EQ(rest.next, kNoThread);
  EXPECT_TRUE(rest.behind.empty());
}

TEST_F(PassRestOnTest, WhatIsLeftIsForTheNextAndTheOthersStayBehindIt) {
  const Rest rest = Pass({11, 12, 13});
  EXPECT_EQ(rest.next, 11);
  EXPECT_EQ(rest.behind, (std::vector<int>{12, 13}));
}

TEST_F(PassRestOnTest, ThoseForWhomNothingIsThereWaitForNobody) {
  const Rest rest = Pass({12});
  EXPECT_EQ(rest.next, 12);
  EXPECT_EQ(rest.behind, (std::vector<int>{13}));
}

TEST_F(PassRestOnTest, TheLastHasNobodyBehindIt) {
  const Rest rest = Pass({13});
  EXPECT_EQ(rest.next, 13);
  EXPECT_TRUE(rest.behind.empty());
}

}  // namespace
}  // namespace tcs
