#include "coordinator/network/wire.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/unit/network/packets.h"

namespace tcs {
namespace {

constexpr VirtualDuration kWay = VirtualDuration::Milliseconds(20);

VirtualTime AtMs(std::int64_t ms) { return VirtualTime::FromNanoseconds(ms * 1'000'000); }

class WireTest : public testing::Test {
 protected:
  static NetworkSpec Spec(const LinkSpec& link) {
    NetworkSpec spec{
        .seed = 1, .addresses = {"10.42.0.1", "10.42.0.2", "192.168.7.9"}, .links = {}};
    spec.links.assign(9, link);
    return spec;
  }

  // Who has received, in order.
  static std::vector<std::size_t> ReceiversUntil(Wire& wire, VirtualTime now) {
    std::vector<std::size_t> receivers;
    wire.Arrive(now,
                [&](std::size_t robot, std::span<const std::byte>) { receivers.push_back(robot); });
    return receivers;
  }
};

TEST_F(WireTest, APacketGoesToTheRobotWithItsAddress) {
  Wire wire(Spec({.latency = kWay}));
  EXPECT_EQ(wire.NextDue(), VirtualTime::Never());
  wire.Send(0, UdpPacket("10.42.0.1", "192.168.7.9"), AtMs(1));
  EXPECT_EQ(wire.NextDue(), AtMs(21));
  EXPECT_TRUE(ReceiversUntil(wire, AtMs(20)).empty());
  EXPECT_EQ(ReceiversUntil(wire, AtMs(21)), std::vector<std::size_t>{2});
  EXPECT_EQ(wire.NextDue(), VirtualTime::Never());
}

TEST_F(WireTest, APacketToNobodysAddressGoesNowhere) {
  Wire wire(Spec({}));
  wire.Send(0, UdpPacket("10.42.0.1", "10.42.0.3"), AtMs(1));
  EXPECT_EQ(wire.NextDue(), VirtualTime::Never());
}

TEST_F(WireTest, BroadcastAndMulticastGoToAllOthersEachOverItsOwnLink) {
  NetworkSpec spec = Spec({.latency = kWay});
  spec.links[1 * 3 + 0].latency = VirtualDuration::Milliseconds(30);
  for (const std::string to : {"255.255.255.255", "10.42.0.255", "239.255.0.1"}) {
    Wire wire(spec);
    wire.Send(1, UdpPacket("10.42.0.2", to), AtMs(0));
    EXPECT_EQ(ReceiversUntil(wire, AtMs(20)), std::vector<std::size_t>{2}) << to;
    EXPECT_EQ(ReceiversUntil(wire, AtMs(30)), std::vector<std::size_t>{0}) << to;
  }
}

TEST_F(WireTest, WhatBeginsAConnectionCountsOnce) {
  Wire wire(Spec({.latency = kWay}));
  const auto begin = [&wire](std::uint32_t sequence, VirtualTime at) {
    wire.Send(0, TcpPacket("10.42.0.1", "10.42.0.2", {.sequence = sequence, .syn = true}), at);
  };
  begin(7, AtMs(0));
  begin(7, AtMs(5));
  EXPECT_EQ(ReceiversUntil(wire, AtMs(100)).size(), 1u);
  begin(8, AtMs(100));  // the next connection from the same port
  EXPECT_EQ(ReceiversUntil(wire, AtMs(200)).size(), 1u);
}

TEST_F(WireTest, ALostDatagramIsLostAndALostSegmentIsSentAgainAfterTheTimeout) {
  Wire wire(Spec({.latency = kWay, .loss = 1}));
  wire.Send(0, UdpPacket("10.42.0.1", "10.42.0.2"), AtMs(0));
  EXPECT_EQ(wire.NextDue(), VirtualTime::Never());
  // A round trip and the least timeout of TCP; then twice as long.
  wire.Send(0, TcpPacket("10.42.0.1", "10.42.0.2", {.sequence = 1, .payload = 10}), AtMs(0));
  EXPECT_EQ(wire.NextDue(), AtMs(240));
  EXPECT_TRUE(ReceiversUntil(wire, AtMs(240)).empty());
  EXPECT_EQ(wire.NextDue(), AtMs(240 + 480));
}

TEST_F(WireTest, TheFirstSegmentOfAConnectionWaitsForASecond) {
  Wire wire(Spec({.latency = kWay, .loss = 1}));
  wire.Send(0, TcpPacket("10.42.0.1", "10.42.0.2", {.sequence = 1, .syn = true}), AtMs(300));
  EXPECT_EQ(wire.NextDue(), AtMs(300 + 1000));
}

TEST_F(WireTest, WhatFoundTheQueueFullTakesItsTimeOnTheLineWhenItIsSentAgain) {
  // 1 ms for each of these packets; there is room for one beside the one that is sent.
  Wire wire(Spec({.bandwidth_bps = 12e6, .queue_bytes = 3000}));
  for (std::uint32_t i = 0; i < 3; ++i) {
    wire.Send(0, TcpPacket("10.42.0.1", "10.42.0.2", {.sequence = i * 1460, .payload = 1460}),
              AtMs(0));
  }
  EXPECT_EQ(ReceiversUntil(wire, AtMs(2)).size(), 2u);
  EXPECT_EQ(wire.NextDue(), AtMs(200));
  EXPECT_TRUE(ReceiversUntil(wire, AtMs(200)).empty());
  EXPECT_EQ(wire.NextDue(), AtMs(201));
  EXPECT_EQ(ReceiversUntil(wire, AtMs(201)).size(), 1u);
}

}  // namespace
}  // namespace tcs
