#include "coordinator/network/lost_segments.h"

#include <gtest/gtest.h>

#include "tests/unit/network/packets.h"

namespace tcs {
namespace {

constexpr VirtualTime kDue = VirtualTime::FromNanoseconds(1000);

LostSegments::Segment Segment(const TcpFields& fields) {
  return {.head = *HeadOf(TcpPacket("10.42.0.1", "10.42.0.2", fields))->tcp};
}

TEST(LostSegmentsTest, WhatIsLostIsSentAgainAfterTheTimeout) {
  LostSegments lost;
  EXPECT_EQ(lost.NextDue(), VirtualTime::Never());
  lost.Lose(Segment({.sequence = 100, .payload = 50}), kDue);
  EXPECT_EQ(lost.NextDue(), kDue);
  EXPECT_FALSE(lost.Take(VirtualTime::FromNanoseconds(999)));
  EXPECT_EQ(lost.Take(kDue)->head.sequence, 100u);
  EXPECT_FALSE(lost.Take(kDue));
}

TEST(LostSegmentsTest, WhatTheKernelHasSentAgainDoesNotComeTwice) {
  LostSegments lost;
  lost.Lose(Segment({.sequence = 100, .payload = 50}), kDue);
  lost.Passed(Segment({.sequence = 150, .payload = 50}).head);
  EXPECT_EQ(lost.NextDue(), kDue);
  lost.Passed(Segment({.sequence = 100, .payload = 40}).head);
  EXPECT_EQ(lost.NextDue(), kDue);
  lost.Passed(Segment({.sequence = 100, .payload = 50}).head);
  EXPECT_EQ(lost.NextDue(), VirtualTime::Never());
}

TEST(LostSegmentsTest, AnAcknowledgementIsMadeUpForByALaterOne) {
  LostSegments lost;
  lost.Lose(Segment({.sequence = 5, .acknowledges = 300}), kDue);
  lost.Passed(Segment({.sequence = 5, .acknowledges = 299}).head);
  EXPECT_EQ(lost.NextDue(), kDue);
  lost.Passed(Segment({.sequence = 5, .acknowledges = 301}).head);
  EXPECT_EQ(lost.NextDue(), VirtualTime::Never());
}

TEST(LostSegmentsTest, SequenceNumbersGoRound) {
  LostSegments lost;
  lost.Lose(Segment({.sequence = 0xfffffff0, .payload = 8}), kDue);
  lost.Passed(Segment({.sequence = 0xffffffe0, .payload = 64}).head);
  EXPECT_EQ(lost.NextDue(), VirtualTime::Never());
}

}  // namespace
}  // namespace tcs
