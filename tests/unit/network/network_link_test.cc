#include "coordinator/network/network_link.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace tcs {
namespace {

VirtualTime At(std::int64_t us) { return VirtualTime::FromNanoseconds(us * 1000); }

NetworkLink LinkWith(const LinkSpec& spec, std::uint64_t seed = 1) {
  return NetworkLink(spec, seed, 0);
}

TEST(NetworkLinkTest, APacketTakesTheLatency) {
  NetworkLink link = LinkWith({.latency = VirtualDuration::Milliseconds(20)});
  EXPECT_EQ(link.Send(At(100), 1000), At(20'100));
}

TEST(NetworkLinkTest, ItsBitsTakeTheirTimeAndThoseBeforeItTheirs) {
  // 1000 bytes at 8 Mbit/s: 1 ms.
  NetworkLink link = LinkWith({.latency = VirtualDuration::Milliseconds(20), .bandwidth_bps = 8e6});
  EXPECT_EQ(link.Send(At(0), 1000), At(21'000));
  EXPECT_EQ(link.Send(At(0), 1000), At(22'000));
  EXPECT_EQ(link.Send(At(500), 1000), At(23'000));
  EXPECT_EQ(link.Send(At(10'000), 1000), At(31'000));
}

TEST(NetworkLinkTest, WhatFindsTheQueueFullIsDroppedAndTakesNoTime) {
  NetworkLink link = LinkWith({.bandwidth_bps = 8e6, .queue_bytes = 2000});
  EXPECT_EQ(link.Send(At(0), 1000), At(1'000));
  EXPECT_EQ(link.Send(At(0), 1000), At(2'000));
  EXPECT_EQ(link.Send(At(0), 1000), std::nullopt);
  EXPECT_EQ(link.counts().dropped, 1u);
  EXPECT_EQ(link.Send(At(1'000), 1000), At(3'000));
}

TEST(NetworkLinkTest, AnIdleLinkTakesAPacketLargerThanItsQueue) {
  NetworkLink link = LinkWith({.bandwidth_bps = 8e6, .queue_bytes = 2000});
  EXPECT_EQ(link.Send(At(0), 9000), At(9'000));
}

TEST(NetworkLinkTest, TheSameSeedLosesTheSamePackets) {
  const LinkSpec spec{.jitter = VirtualDuration::Milliseconds(5), .loss = 0.1};
  const auto fates = [&spec](std::uint64_t seed) {
    NetworkLink link = LinkWith(spec, seed);
    std::vector<std::optional<VirtualTime>> arrivals;
    for (int i = 0; i < 10'000; ++i) arrivals.push_back(link.Send(At(i * 1000), 100));
    return std::pair(arrivals, link.counts().lost);
  };
  const auto [arrivals, lost] = fates(7);
  EXPECT_EQ(arrivals, fates(7).first);
  EXPECT_NE(arrivals, fates(8).first);
  EXPECT_NEAR(static_cast<double>(lost), 1000, 120);
}

TEST(NetworkLinkTest, JitterIsWithinItsBoundAndNobodyIsOvertaken) {
  NetworkLink link = LinkWith(
      {.latency = VirtualDuration::Milliseconds(10), .jitter = VirtualDuration::Milliseconds(4)});
  VirtualTime last;
  std::int64_t least = 1'000'000'000, most = 0;
  for (int i = 0; i < 1000; ++i) {
    const VirtualTime sent = At(i * 1000);
    const VirtualTime arrives = link.Send(sent, 100).value();
    EXPECT_GE(arrives, last);
    last = arrives;
    least = std::min(least, (arrives - sent).ns());
    most = std::max(most, (arrives - sent).ns());
  }
  EXPECT_GE(least, 10'000'000);
  EXPECT_LT(most, 14'000'000);
  EXPECT_GT(most, 13'500'000);
}

TEST(NetworkLinkTest, AMessageIsThereWhenItsLastPacketIs) {
  // 2 packets of 1500 bytes and one of 84, at 12 Mbit/s: 1 us for 1.5 bytes.
  NetworkLink link = LinkWith({.bandwidth_bps = 12e6});
  const NetworkLink::Passage passage = link.SendMessage(At(0), 3000);
  EXPECT_TRUE(passage.is_whole);
  EXPECT_EQ(passage.arrives, At(2056));
  EXPECT_EQ(link.counts().packets, 3u);
}

TEST(NetworkLinkTest, AMessageIsLostWithAnyOfItsPackets) {
  NetworkLink link = LinkWith({.loss = 0.1});
  int whole = 0;
  for (int i = 0; i < 1000; ++i) whole += link.SendMessage(At(i), 10 * 1472).is_whole;
  EXPECT_NEAR(whole, 349, 60);  // 0.9 to the tenth
}

}  // namespace
}  // namespace tcs
