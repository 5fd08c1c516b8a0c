// Readers get what suits them: the rules of DDS, policy by policy.
#include <gtest/gtest.h>

#include "coordinator/dds/qos.h"

namespace tcs::dds {
namespace {

constexpr auto Ms = VirtualDuration::Milliseconds;

// Whether a reader that wants `more` matches a writer that offers `less`, and the other way round.
void ExpectMoreServesLess(const Qos& more, const Qos& less) {
  EXPECT_NE(WhatDoesNotMatch(more, less), std::nullopt);
  EXPECT_EQ(WhatDoesNotMatch(less, more), std::nullopt);
  EXPECT_EQ(WhatDoesNotMatch(more, more), std::nullopt);
  EXPECT_EQ(WhatDoesNotMatch(less, less), std::nullopt);
}

TEST(QosMatch, ReliableServesBestEffort) {
  Qos more, less;
  less.reliability = Reliability::kBestEffort;
  ExpectMoreServesLess(more, less);
  EXPECT_EQ(WhatDoesNotMatch(more, less), "wants reliable, but is offered best_effort");
}

TEST(QosMatch, TransientLocalServesVolatile) {
  Qos more, less;
  more.durability = Durability::kTransientLocal;
  ExpectMoreServesLess(more, less);
  EXPECT_EQ(WhatDoesNotMatch(more, less), "wants transient_local, but is offered volatile");
}

TEST(QosMatch, ShorterDeadlinesServeLongerOnes) {
  Qos more, less;
  more.deadline = Ms(10);
  ExpectMoreServesLess(more, less);
  less.deadline = Ms(20);
  ExpectMoreServesLess(more, less);
}

TEST(QosMatch, ShorterLeasesServeLongerOnes) {
  Qos more, less;
  more.lease = Ms(10);
  ExpectMoreServesLess(more, less);
}

TEST(QosMatch, LivelinessByTopicServesAutomatic) {
  Qos more, less;
  more.liveliness = Liveliness::kManualByTopic;
  ExpectMoreServesLess(more, less);
  less.liveliness = Liveliness::kManualByParticipant;
  ExpectMoreServesLess(more, less);
}

TEST(QosMatch, HistoryAndLifespanDoNotMatter) {
  Qos wanted, offered;
  wanted.history = History::kKeepAll;
  wanted.depth = 99;
  offered.lifespan = Ms(1);
  EXPECT_EQ(WhatDoesNotMatch(wanted, offered), std::nullopt);
}

}  // namespace
}  // namespace tcs::dds
