#include "coordinator/network/packet.h"

#include <gtest/gtest.h>
#include <netinet/in.h>

#include "tests/unit/network/packets.h"

namespace tcs {
namespace {

TEST(PacketTest, AddressesAndTheSegmentAreRead) {
  const auto head = HeadOf(TcpPacket(
      "10.42.0.1", "10.42.0.2", {.sequence = 7, .acknowledges = 9, .fin = true, .payload = 3}));
  ASSERT_TRUE(head && head->tcp);
  EXPECT_EQ(head->from, 0x0a2a0001u);
  EXPECT_EQ(head->to, 0x0a2a0002u);
  EXPECT_EQ(head->protocol, IPPROTO_TCP);
  EXPECT_EQ(head->tcp->flow.to_port, 5000);
  EXPECT_EQ(head->tcp->acknowledges, 9u);
  EXPECT_EQ(head->tcp->end(), 11u);  // three bytes and FIN
}

TEST(PacketTest, WhatIsNoPacketOrCutShortIsNone) {
  PacketBytes packet = UdpPacket("10.42.0.1", "10.42.0.2", 128);
  EXPECT_TRUE(HeadOf(packet));
  EXPECT_FALSE(HeadOf(std::span(packet).first(127)));
  EXPECT_FALSE(HeadOf(std::span(packet).first(19)));
  EXPECT_FALSE(HeadOf({}));
  packet[0] = std::byte{0x65};  // IPv6
  EXPECT_FALSE(HeadOf(packet));
  packet[0] = std::byte{0x4f};  // a head longer than it says
  packet.resize(30);
  EXPECT_FALSE(HeadOf(packet));
}

TEST(PacketTest, ASegmentWhoseHeadIsNotWholeIsNone) {
  PacketBytes packet = TcpPacket("10.42.0.1", "10.42.0.2", {});
  packet[32] = std::byte{0xf0};  // its head would have 60 bytes
  const auto head = HeadOf(packet);
  ASSERT_TRUE(head);
  EXPECT_FALSE(head->tcp);
}

}  // namespace
}  // namespace tcs
