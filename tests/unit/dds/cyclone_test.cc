// Our bytes are those of a real Cyclone writer, and a real Cyclone reader understands ours.
#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <gtest/gtest.h>

#include <cstring>

#include "coordinator/dds/participant_info.h"
#include "coordinator/dds/ros_messages.h"
#include "coordinator/dds/ros_names.h"
#include "tests/unit/dds/samples.h"

namespace tcs::dds {
namespace {

using Bytes = std::vector<std::byte>;

// A domain without a network: reader and writer meet inside the process.
constexpr const char* kConfiguration = "<General><Transport>none</Transport></General>";
constexpr dds_domainid_t kDomain = 42;

class Cyclone : public testing::Test {
 protected:
  void SetUp() override {
    domain_ = dds_create_domain(kDomain, kConfiguration);
    ASSERT_GT(domain_, 0) << dds_strretcode(domain_);
    participant_ = dds_create_participant(kDomain, nullptr, nullptr);
    ASSERT_GT(participant_, 0) << dds_strretcode(participant_);
  }
  void TearDown() override { dds_delete(domain_); }

  template <class Message>
  void Connect(const char* topic_name) {
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_INFINITY);
    const dds_entity_t topic =
        dds_create_topic(participant_, &DescriptorOf<Message>(), topic_name, nullptr, nullptr);
    ASSERT_GT(topic, 0) << dds_strretcode(topic);
    reader_ = dds_create_reader(participant_, topic, qos, nullptr);
    writer_ = dds_create_writer(participant_, topic, qos, nullptr);
    dds_delete_qos(qos);
    ASSERT_GT(reader_, 0);
    ASSERT_GT(writer_, 0);
  }

  // What a Cyclone writer makes of the message.
  template <class Message>
  Bytes Written(const Owned<Message>& message) {
    EXPECT_EQ(dds_write(writer_, &*message), DDS_RETCODE_OK);
    ddsi_serdata* serdata = nullptr;
    dds_sample_info_t info;
    EXPECT_EQ(dds_takecdr(reader_, &serdata, 1, &info, DDS_ANY_STATE), 1);
    if (serdata == nullptr) return {};
    Bytes bytes(ddsi_serdata_size(serdata));
    ddsi_serdata_to_ser(serdata, 0, bytes.size(), bytes.data());
    ddsi_serdata_unref(serdata);
    return bytes;
  }

  // Ours and Cyclone's are the same bytes, and Cyclone's are read as the same message.
  template <class Message>
  void ExpectTheSameBytes(const char* topic_name, const Owned<Message>& message) {
    Connect<Message>(topic_name);
    const Bytes theirs = Written(message);
    EXPECT_EQ(ToCdr(message), theirs);
    const auto read = FromCdr<Message>(theirs);
    ASSERT_TRUE(std::holds_alternative<Owned<Message>>(read)) << std::get<CdrError>(read).message;
    EXPECT_EQ(ToCdr(std::get<Owned<Message>>(read)), theirs);
  }

  dds_entity_t domain_ = 0, participant_ = 0, reader_ = 0, writer_ = 0;
};

TEST_F(Cyclone, WritesTheSameOdometry) {
  ExpectTheSameBytes("rt/odom", ToOdometry(1'700'000'000'123'456'789, "hunter", Flying()));
}

TEST_F(Cyclone, WritesTheSameImu) {
  ExpectTheSameBytes("rt/imu", ToImu(1'700'000'000'000'000'001, "hunter", Flying(),
                                     InertialSensor({0, 0, -9.8}).Sample({}, Flying())));
}

TEST_F(Cyclone, WritesTheSameJointState) {
  const std::vector<std::string> bodies = {"a", "longer"};
  ExpectTheSameBytes("rt/joint_states", ToJointState(5, bodies, std::vector{Flying(), Flying()}));
}

TEST_F(Cyclone, WritesTheSameJointStateOfARobot) {
  const std::vector<std::string> joints = {"elbow", "wrist_1"};
  ExpectTheSameBytes("rt/joint_states",
                     ToRobotJointState(5, joints, std::vector<JointState>{{1, 2, 3}, {4, 5, 6}}));
}

TEST_F(Cyclone, WritesTheSameFloat64MultiArray) {
  Owned<Float64MultiArrayMessage> array;
  Resize(&array->layout.dim, 1);
  SetText(&array->layout.dim._buffer[0].label, "joints");
  Resize(&array->data, 2);
  array->data._buffer[1] = -0.5;
  ExpectTheSameBytes("rt/commands", array);
}

TEST_F(Cyclone, WritesTheSameTwist) { ExpectTheSameBytes("rt/twist", ToTwist(Flying())); }

TEST_F(Cyclone, WritesTheSameClock) { ExpectTheSameBytes("rt/clock", ToClock(1'234'567'890)); }

TEST_F(Cyclone, WritesTheSameWrench) {
  Owned<WrenchMessage> wrench;
  *wrench = {{1, -2, 3.5}, {0, 0, 1e-300}};
  ExpectTheSameBytes("rt/wrench", wrench);
}

TEST_F(Cyclone, WritesTheSameParticipant) {
  const ParticipantInfo info{{1, 2, 3}, {{"/", "tcs", {{4}}, {{5}, {6}}}, {"/a", "b", {}, {}}}};
  const auto message = FromCdr<HumbleParticipantMessage>(EncodeParticipant(info, GidForm::kHumble));
  ASSERT_TRUE(std::holds_alternative<Owned<HumbleParticipantMessage>>(message));
  ExpectTheSameBytes("ros_discovery_info", std::get<0>(message));
}

TEST_F(Cyclone, ReadsWhatWeWrite) {
  Connect<OdometryMessage>("rt/odom");
  const Bytes ours = ToCdr(ToOdometry(1'700'000'000'123'456'789, "hunter", Flying()));
  // Cyclone's type of the topic, which a sample carries.
  ASSERT_EQ(dds_write(writer_, &*Owned<OdometryMessage>()), DDS_RETCODE_OK);
  ddsi_serdata* empty = nullptr;
  dds_sample_info_t empty_info;
  ASSERT_EQ(dds_takecdr(reader_, &empty, 1, &empty_info, DDS_ANY_STATE), 1);
  ddsrt_iovec_t piece{const_cast<std::byte*>(ours.data()), ours.size()};
  ddsi_serdata* serdata = ddsi_serdata_from_ser_iov(empty->type, SDK_DATA, 1, &piece, ours.size());
  ddsi_serdata_unref(empty);
  ASSERT_NE(serdata, nullptr);
  ASSERT_EQ(dds_forwardcdr(writer_, serdata), DDS_RETCODE_OK);
  Owned<OdometryMessage> read;
  void* sample = &*read;
  dds_sample_info_t info;
  ASSERT_EQ(dds_take(reader_, &sample, &info, 1, 1), 1);
  EXPECT_STREQ(read->child_frame_id, "hunter");
  EXPECT_EQ(read->pose.pose.position.x, 1);
  EXPECT_EQ(read->twist.twist.angular.z, 9);
}

TEST_F(Cyclone, KnowsTheTypesByRosNames) {
  EXPECT_EQ(DescriptorOf<OdometryMessage>().m_typename, DdsType("nav_msgs/msg/Odometry"));
  EXPECT_EQ(DescriptorOf<ImuMessage>().m_typename, DdsType("sensor_msgs/msg/Imu"));
  EXPECT_EQ(DescriptorOf<JointStateMessage>().m_typename, DdsType("sensor_msgs/msg/JointState"));
  EXPECT_EQ(DescriptorOf<Float64MultiArrayMessage>().m_typename,
            DdsType("std_msgs/msg/Float64MultiArray"));
  EXPECT_EQ(DescriptorOf<TwistMessage>().m_typename, DdsType("geometry_msgs/msg/Twist"));
  EXPECT_EQ(DescriptorOf<WrenchMessage>().m_typename, DdsType("geometry_msgs/msg/Wrench"));
  EXPECT_EQ(DescriptorOf<ClockMessage>().m_typename, DdsType(kClockMessageName));
  EXPECT_EQ(DescriptorOf<HumbleParticipantMessage>().m_typename,
            DdsType("rmw_dds_common/msg/ParticipantEntitiesInfo"));
}

}  // namespace
}  // namespace tcs::dds
