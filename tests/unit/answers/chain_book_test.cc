#include "coordinator/answers/chain_book.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace tcs {
namespace {

constexpr std::int64_t kTick = 1'000'000;
constexpr ChainBook::Who kSeer{.thread = 1, .client = 0};
constexpr ChainBook::Who kPilot{.thread = 2, .client = 1};
constexpr ChainBook::Who kHelper{.thread = 3, .client = 1};

// A camera whose image the seer sees, and tells the pilot, who has a gyroscope, too, of.
class ChainBookTest : public testing::Test {
 protected:
  void Open(std::vector<ChainBook::Chain> chains = {}) {
    book_.Open({"r/seer", "r/pilot"}, {{"camera", 50 * kTick}, {"gyro", 5 * kTick}},
               {{"motors", 3 * kTick}}, std::move(chains));
  }
  // The image of that time is in the pilot's socket 30 ms later.
  Lineage Seen(std::int64_t sampled_ns) {
    book_.Took(kSeer, book_.Sampled(0, sampled_ns), sampled_ns + 10 * kTick,
               sampled_ns + 12 * kTick);
    return book_.Sends(kSeer, sampled_ns + 30 * kTick);
  }
  const ChainFigures& Of(const std::string& name) {
    all_ = book_.Conclude();
    const auto found = std::ranges::find(all_, name, &ChainFigures::name);
    static const ChainFigures kNone;
    return found == all_.end() ? kNone : *found;
  }

  ChainBook book_;
  std::vector<ChainFigures> all_;
};

TEST_F(ChainBookTest, TheHopsOfACommandAreTheWholeOfItsAge) {
  Open();
  book_.Took(kPilot, Seen(100 * kTick), 131 * kTick, 140 * kTick);
  book_.Commanded(kPilot, 0, 145 * kTick);
  const ChainFigures& chain = Of("camera->motors");
  EXPECT_EQ(chain.age.max(), 48 * kTick);
  EXPECT_EQ(chain.path, (std::vector<std::string>{"r/seer", "r/pilot"}));
  ASSERT_EQ(chain.worst.size(), 1u);
  std::vector<std::int64_t> hops;
  for (const ChainHop& hop : chain.worst[0].hops) hops.push_back(hop.ns / kTick);
  EXPECT_EQ(hops, (std::vector<std::int64_t>{10, 2, 18, 0, 1, 9, 5, 0, 3}));
  EXPECT_EQ(std::accumulate(hops.begin(), hops.end(), std::int64_t{0}), 48);
}

TEST_F(ChainBookTest, WhatIsSentAgainForWantOfNewsIsHeld) {
  Open();
  book_.Took(kPilot, Seen(100 * kTick), 131 * kTick, 140 * kTick);
  book_.Commanded(kPilot, 0, 145 * kTick);
  book_.Commanded(kPilot, 0, 175 * kTick);
  const ChainCase& worst = Of("camera->motors").worst.front();
  ASSERT_EQ(worst.hops.size(), 9u);
  EXPECT_EQ(worst.hops[6].ns, 5 * kTick);
  EXPECT_EQ(worst.hops[7].of, ChainHop::Of::kHeld);
  EXPECT_EQ(worst.hops[7].ns, 30 * kTick);
}

TEST_F(ChainBookTest, EachSensorIsAChainOfItsOwn) {
  Open();
  book_.Took(kPilot, Seen(100 * kTick), 131 * kTick, 140 * kTick);
  book_.Took(kPilot, book_.Sampled(1, 140 * kTick), 140 * kTick, 141 * kTick);
  book_.Commanded(kPilot, 0, 142 * kTick);
  EXPECT_EQ(Of("camera->motors").age.max(), 45 * kTick);
  EXPECT_EQ(Of("gyro->motors").age.max(), 5 * kTick);
}

TEST_F(ChainBookTest, AnOlderSampleIsNoNews) {
  Open();
  const Lineage old = Seen(100 * kTick);
  book_.Took(kPilot, Seen(150 * kTick), 181 * kTick, 182 * kTick);
  book_.Took(kPilot, old, 190 * kTick, 191 * kTick);
  book_.Commanded(kPilot, 0, 200 * kTick);
  EXPECT_EQ(Of("camera->motors").age.max(), 53 * kTick);
}

TEST_F(ChainBookTest, AThreadThatTakesNothingKnowsWhatItsClientDoes) {
  Open();
  book_.Took(kPilot, book_.Sampled(1, 100 * kTick), 100 * kTick, 101 * kTick);
  book_.Commanded(kHelper, 0, 104 * kTick);
  EXPECT_EQ(Of("gyro->motors").age.max(), 7 * kTick);
}

// Samples of 5, 10, 15 and 20 ms; the one of 10 and that of 15 are first known of with that of 20.
TEST_F(ChainBookTest, EachSampleHasAReaction) {
  Open();
  for (const std::int64_t sampled : {5 * kTick, 20 * kTick}) {
    book_.Took(kPilot, book_.Sampled(1, sampled), sampled, sampled);
    book_.Commanded(kPilot, 0, sampled + kTick);
    book_.Commanded(kPilot, 0, sampled + 2 * kTick);
  }
  const ChainFigures& chain = Of("gyro->motors");
  EXPECT_EQ(chain.age.count(), 4);
  EXPECT_EQ(chain.reaction.count(), 4);
  EXPECT_EQ(chain.reaction.max(), 14 * kTick);
}

TEST_F(ChainBookTest, ADeadlineIsMissedByOlderSamples) {
  Open({{.name = "camera->motors", .deadline_ns = 50 * kTick}});
  book_.Took(kPilot, Seen(100 * kTick), 131 * kTick, 140 * kTick);
  book_.Commanded(kPilot, 0, 147 * kTick);
  book_.Commanded(kPilot, 0, 148 * kTick);
  const ChainFigures& chain = Of("camera->motors");
  EXPECT_EQ(chain.missed, 1);
  EXPECT_EQ(chain.first_missed_ns, 151 * kTick);
  EXPECT_EQ(all_.size(), 1u);
}

TEST_F(ChainBookTest, ANamedChainGoesThroughItsClients) {
  Open({{.name = "eye_to_hand", .through = {0, 1}}});
  book_.Took(kPilot, Seen(100 * kTick), 131 * kTick, 140 * kTick);
  // A newer image comes to it straight away, past the seer.
  book_.Took(kPilot, book_.Sampled(0, 150 * kTick), 150 * kTick, 151 * kTick);
  book_.Commanded(kPilot, 0, 152 * kTick);
  EXPECT_EQ(Of("eye_to_hand").age.max(), 55 * kTick);
  EXPECT_EQ(Of("camera->motors").age.max(), 5 * kTick);
}

TEST_F(ChainBookTest, ProgramsThatTellEachOtherEndNowhere) {
  Open();
  Lineage said = book_.Sampled(0, 0);
  for (std::int64_t at = 1; at < 100; ++at) {
    // Each time a newer sample, so that it is news.
    book_.Took(kSeer, said, at * kTick, at * kTick);
    book_.Took(kPilot, book_.Sends(kSeer, at * kTick), at * kTick, at * kTick);
    said = book_.Sends(kPilot, at * kTick);
  }
  book_.Commanded(kPilot, 0, 100 * kTick);
  EXPECT_LE(Of("camera->motors").path.size(), 17u);
}

}  // namespace
}  // namespace tcs
