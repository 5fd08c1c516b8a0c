// What rosbag2 of ROS 2 Humble reads in metadata.yaml.
#include "coordinator/record/bag_metadata.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

namespace tcs::record {
namespace {

BagMetadata Two() {
  dds::Qos qos;
  qos.reliability = dds::Reliability::kBestEffort;
  qos.depth = 5;
  return {"bag_0.db3",
          1'700'000'000'000'000'007,
          1'700'000'002'500'000'007,
          11,
          {{"/odom", "nav_msgs/msg/Odometry", {dds::Qos(), qos}, 9},
           {"/imu", "sensor_msgs/msg/Imu", {}, 2}}};
}

TEST(BagMetadata, HasTheKeysOfVersionFive) {
  const YAML::Node info = YAML::Load(MetadataFile(Two()))["rosbag2_bagfile_information"];
  EXPECT_EQ(info["version"].as<int>(), 5);
  EXPECT_EQ(info["storage_identifier"].as<std::string>(), "sqlite3");
  EXPECT_EQ(info["duration"]["nanoseconds"].as<std::int64_t>(), 2'500'000'000);
  EXPECT_EQ(info["starting_time"]["nanoseconds_since_epoch"].as<std::int64_t>(),
            1'700'000'000'000'000'007);
  EXPECT_EQ(info["message_count"].as<int>(), 11);
  EXPECT_EQ(info["compression_format"].as<std::string>(), "");
  EXPECT_EQ(info["compression_mode"].as<std::string>(), "");
  ASSERT_EQ(info["relative_file_paths"].size(), 1u);
  EXPECT_EQ(info["relative_file_paths"][0].as<std::string>(), "bag_0.db3");
  ASSERT_EQ(info["files"].size(), 1u);
  EXPECT_EQ(info["files"][0]["path"].as<std::string>(), "bag_0.db3");
  EXPECT_EQ(info["files"][0]["message_count"].as<int>(), 11);
  EXPECT_EQ(info["files"][0]["duration"]["nanoseconds"].as<std::int64_t>(), 2'500'000'000);
  ASSERT_EQ(info["topics_with_message_count"].size(), 2u);
  const YAML::Node odom = info["topics_with_message_count"][0];
  EXPECT_EQ(odom["message_count"].as<int>(), 9);
  EXPECT_EQ(odom["topic_metadata"]["name"].as<std::string>(), "/odom");
  EXPECT_EQ(odom["topic_metadata"]["type"].as<std::string>(), "nav_msgs/msg/Odometry");
  EXPECT_EQ(odom["topic_metadata"]["serialization_format"].as<std::string>(), "cdr");
  EXPECT_EQ(odom["topic_metadata"]["offered_qos_profiles"].as<std::string>(),
            OfferedQosYaml(Two().topics[0].offered));
}

TEST(BagMetadata, OfAnEmptyBagHasItsKeysToo) {
  BagMetadata empty;
  empty.file = "bag_0.db3";
  const YAML::Node info = YAML::Load(MetadataFile(empty))["rosbag2_bagfile_information"];
  EXPECT_EQ(info["message_count"].as<int>(), 0);
  EXPECT_TRUE(info["topics_with_message_count"].IsSequence());
  EXPECT_EQ(info["topics_with_message_count"].size(), 0u);
}

TEST(BagMetadata, InTheDatabaseIsTheSameWithoutItsFirstKey) {
  EXPECT_EQ(YAML::Dump(YAML::Load(MetadataYaml(Two()))),
            YAML::Dump(YAML::Load(MetadataFile(Two()))["rosbag2_bagfile_information"]));
}

TEST(OfferedQos, OfRos2sDefaultIsWhatRosbag2WritesForIt) {
  EXPECT_EQ(OfferedQosYaml(std::vector{dds::Qos()}),
            "- history: 1\n  depth: 10\n  reliability: 1\n  durability: 2\n"
            "  deadline:\n    sec: 9223372036\n    nsec: 854775807\n"
            "  lifespan:\n    sec: 9223372036\n    nsec: 854775807\n"
            "  liveliness: 1\n"
            "  liveliness_lease_duration:\n    sec: 9223372036\n    nsec: 854775807\n"
            "  avoid_ros_namespace_conventions: false");
}

TEST(OfferedQos, HasEveryPolicy) {
  dds::Qos qos;
  qos.reliability = dds::Reliability::kBestEffort;
  qos.history = dds::History::kKeepAll;
  qos.durability = dds::Durability::kTransientLocal;
  qos.liveliness = dds::Liveliness::kManualByTopic;
  qos.deadline = VirtualDuration::Milliseconds(1500);
  qos.lifespan = VirtualDuration::Seconds(2);
  qos.lease = VirtualDuration::Nanoseconds(3);
  const YAML::Node yaml = YAML::Load(OfferedQosYaml(std::vector{dds::Qos(), qos}));
  ASSERT_EQ(yaml.size(), 2u);
  EXPECT_EQ(yaml[1]["history"].as<int>(), 2);
  EXPECT_EQ(yaml[1]["depth"].as<int>(), 0);
  EXPECT_EQ(yaml[1]["reliability"].as<int>(), 2);
  EXPECT_EQ(yaml[1]["durability"].as<int>(), 1);
  EXPECT_EQ(yaml[1]["liveliness"].as<int>(), 3);
  EXPECT_EQ(yaml[1]["deadline"]["sec"].as<int>(), 1);
  EXPECT_EQ(yaml[1]["deadline"]["nsec"].as<int>(), 500'000'000);
  EXPECT_EQ(yaml[1]["lifespan"]["sec"].as<int>(), 2);
  EXPECT_EQ(yaml[1]["liveliness_lease_duration"]["nsec"].as<int>(), 3);
}

TEST(OfferedQos, OfNobodyIsNothing) { EXPECT_EQ(OfferedQosYaml({}), ""); }

}  // namespace
}  // namespace tcs::record
