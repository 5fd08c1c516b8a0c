// Messages become the bytes that DDS says, and whatever bytes come are refused or are a message.
#include "coordinator/dds/cdr.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "coordinator/dds/participant_info.h"
#include "coordinator/dds/ros_messages.h"
#include "tests/unit/dds/samples.h"

namespace tcs::dds {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Bytes = std::vector<std::byte>;

Bytes Of(const std::vector<int>& numbers) {
  Bytes bytes;
  for (const int number : numbers) bytes.push_back(static_cast<std::byte>(number));
  return bytes;
}

template <class Message>
Owned<Message> Decoded(const Bytes& cdr) {
  auto result = FromCdr<Message>(cdr);
  if (auto* error = std::get_if<CdrError>(&result)) {
    ADD_FAILURE() << error->message;
    return {};
  }
  return std::get<Owned<Message>>(std::move(result));
}

template <class Message>
std::string Complaint(const Bytes& cdr) {
  const auto result = FromCdr<Message>(cdr);
  const auto* error = std::get_if<CdrError>(&result);
  return error == nullptr ? "" : error->message;
}

TEST(Cdr, AClockIsItsTwelveBytes) {
  EXPECT_EQ(ToCdr(ToClock(3'000'000'005)), Of({0, 1, 0, 0, 3, 0, 0, 0, 5, 0, 0, 0}));
}

TEST(Cdr, PaddingIsSaidInTheEncapsulation) {
  // A text's length and its bytes, the last one zero: 2, 3, 4 and 5 of them.
  for (const auto& [text, padding] :
       std::vector<std::pair<std::string, int>>{{"a", 2}, {"ab", 1}, {"abc", 0}, {"abcd", 3}}) {
    Owned<HeaderMessage> header;
    SetText(&header->frame_id, text);
    const Bytes cdr = ToCdr(header);
    EXPECT_EQ(std::to_integer<int>(cdr[3]), padding) << text;
    EXPECT_EQ(cdr.size(), 4 + 8 + 4 + text.size() + 1 + static_cast<std::size_t>(padding));
    EXPECT_STREQ(Decoded<HeaderMessage>(cdr)->frame_id, text.c_str());
  }
}

TEST(Cdr, MessagesComeBackAsTheyWere) {
  const auto odometry =
      Decoded<OdometryMessage>(ToCdr(ToOdometry(7'000'000'001, "hunter", Flying())));
  EXPECT_EQ(odometry->header.stamp.sec, 7);
  EXPECT_EQ(odometry->header.stamp.nanosec, 1u);
  EXPECT_STREQ(odometry->header.frame_id, "world");
  EXPECT_STREQ(odometry->child_frame_id, "hunter");
  EXPECT_EQ(odometry->pose.pose.position.z, 3);
  EXPECT_EQ(odometry->pose.pose.orientation.w, 0.8);
  EXPECT_EQ(odometry->twist.twist.angular.z, 9);

  const std::vector<std::string> bodies = {"a", "bb"};
  const auto joints =
      Decoded<JointStateMessage>(ToCdr(ToJointState(1, bodies, std::vector{Flying(), Flying()})));
  ASSERT_EQ(joints->name._length, 12u);
  EXPECT_STREQ(joints->name._buffer[11], "bb/roll");
  EXPECT_EQ(joints->effort._length, 0u);
}

TEST(Cdr, EveryEncodingOfAFinalTypeIsUnderstood) {
  // 1.0, 2.0 … 6.0 in both byte orders; in XCDR2 alike, for here nothing needs aligning.
  Bytes little, big;
  for (int i = 1; i <= 6; ++i) {
    const double number = i;
    std::array<std::byte, sizeof number> bytes;
    std::memcpy(bytes.data(), &number, sizeof number);
    little.insert(little.end(), bytes.begin(), bytes.end());
    big.insert(big.end(), bytes.rbegin(), bytes.rend());
  }
  for (const int encoding : {0, 1, 6, 7}) {
    SCOPED_TRACE(encoding);
    Bytes cdr = Of({0, encoding, 0, 0});
    const Bytes& data = encoding % 2 == 0 ? big : little;
    cdr.insert(cdr.end(), data.begin(), data.end());
    const auto wrench = Decoded<WrenchMessage>(cdr);
    EXPECT_EQ(wrench->force.x, 1);
    EXPECT_EQ(wrench->torque.z, 6);
  }
}

TEST(Cdr, OtherEncodingsAreRefusedByNumber) {
  Bytes cdr = ToCdr(ToTwist(Flying()));
  cdr[1] = std::byte{3};
  EXPECT_THAT(Complaint<TwistMessage>(cdr), HasSubstr("is encoded as 0x0003"));
  cdr[0] = std::byte{0xc0};
  EXPECT_THAT(Complaint<TwistMessage>(cdr), HasSubstr("is encoded as 0xc003"));
}

TEST(Cdr, BytesOfAnotherTypeAreRefused) {
  const Bytes odometry = ToCdr(ToOdometry(7, "hunter", Flying()));
  EXPECT_THAT(Complaint<WrenchMessage>(odometry), HasSubstr("bytes are left over"));
  EXPECT_THAT(Complaint<JointStateMessage>(odometry), HasSubstr("is no sensor_msgs::msg::dds_::"));
  EXPECT_THAT(Complaint<OdometryMessage>(ToCdr(ToTwist(Flying()))),
              HasSubstr("cut off or of another type"));
  EXPECT_THAT(Complaint<ClockMessage>({}), HasSubstr("0 bytes"));
}

template <class Message>
void ExpectNoPrefixIsAMessage(const Bytes& whole) {
  // The last three bytes may be padding.
  for (std::size_t size = 0; size + 4 <= whole.size(); ++size) {
    EXPECT_NE(Complaint<Message>(Bytes(whole.begin(), whole.begin() + static_cast<long>(size))), "")
        << size << " of " << whole.size();
  }
}

TEST(Cdr, WhatIsCutOffIsRefusedWhereverItIsCut) {
  const std::vector<std::string> bodies = {"one", "another"};
  ExpectNoPrefixIsAMessage<OdometryMessage>(ToCdr(ToOdometry(7, "hunter", Flying())));
  ExpectNoPrefixIsAMessage<ImuMessage>(
      ToCdr(ToImu(7, "b", Flying(), InertialSensor({0, 0, -9.8}).Sample({}, Flying()))));
  ExpectNoPrefixIsAMessage<JointStateMessage>(
      ToCdr(ToJointState(1, bodies, std::vector{Flying(), Flying()})));
  ExpectNoPrefixIsAMessage<WrenchMessage>(ToCdr(Owned<WrenchMessage>()));
  ExpectNoPrefixIsAMessage<ClockMessage>(ToCdr(ToClock(5)));
  ExpectNoPrefixIsAMessage<HumbleParticipantMessage>(
      EncodeParticipant({{1}, {{"/", "n", {{2}, {3}}, {{4}}}}}, GidForm::kHumble));
}

// What was accepted is a message: it can be written again, and read again.
template <class Message>
int AcceptedOf(const Bytes& seed, std::mt19937_64* random) {
  int accepted = 0;
  for (int round = 0; round < 20'000; ++round) {
    Bytes cdr = seed;
    const int changes = 1 + static_cast<int>((*random)() % 8);
    for (int i = 0; i < changes; ++i) {
      // Small numbers too, which make lengths that nearly fit.
      const std::uint64_t bits = (*random)();
      cdr[bits % cdr.size()] = static_cast<std::byte>(bits >> 32 & (bits >> 40 & 1 ? 0xff : 0x0f));
    }
    if ((*random)() % 4 == 0) cdr.resize((*random)() % (cdr.size() + 9));
    if (cdr.size() >= 4 && (*random)() % 2 == 0) {
      cdr[0] = std::byte{0};
      cdr[1] = static_cast<std::byte>(std::array{0, 1, 6, 7}[(*random)() % 4]);
    }
    const auto result = FromCdr<Message>(cdr);
    if (const auto* message = std::get_if<Owned<Message>>(&result)) {
      ++accepted;
      const Bytes again = ToCdr(*message);
      EXPECT_EQ(ToCdr(Decoded<Message>(again)), again);
    }
  }
  return accepted;
}

TEST(Cdr, ForeignBytesNeverCrash) {
  std::mt19937_64 random(1);
  const std::vector<std::string> bodies = {"one", "another"};
  const Bytes joints = ToCdr(ToJointState(1, bodies, std::vector{Flying(), Flying()}));
  const Bytes info = EncodeParticipant({{1}, {{"/", "n", {{2}, {3}}, {{4}}}}}, GidForm::kHumble);
  const Bytes odometry = ToCdr(ToOdometry(7, "hunter", Flying()));
  // Some are messages with other numbers in them, else nothing was tried but the checks.
  EXPECT_GT(AcceptedOf<JointStateMessage>(joints, &random), 100);
  EXPECT_GT(AcceptedOf<HumbleParticipantMessage>(info, &random), 100);
  EXPECT_GT(AcceptedOf<OdometryMessage>(odometry, &random), 100);
}

TEST(Cdr, LengthsBeyondTheBytesAreRefusedWithoutAllocatingThem) {
  // A JointState whose list of names claims 2^32 - 1 of them.
  Bytes cdr = ToCdr(ToJointState(1, {}, {}));
  const std::size_t names = 4 + 8 + 4 + 8;  // encapsulation, stamp, length and text of "world"
  for (std::size_t i = 0; i < 4; ++i) cdr[names + i] = std::byte{0xff};
  EXPECT_THAT(Complaint<JointStateMessage>(cdr), HasSubstr("cut off"));
}

TEST(Cdr, TextsThatDoNotEndAreRefused) {
  Owned<OdometryMessage> odometry = ToOdometry(7, "hunter", Flying());
  Bytes cdr = ToCdr(odometry);
  const std::size_t end_of_world = 4 + 8 + 4 + 5;
  ASSERT_EQ(cdr[end_of_world], std::byte{0});
  cdr[end_of_world] = std::byte{'!'};
  EXPECT_NE(Complaint<OdometryMessage>(cdr), "");
}

}  // namespace
}  // namespace tcs::dds
