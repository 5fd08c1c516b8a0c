// metadata.yaml of a rosbag2 bag, in version 5, that of ROS 2 Humble, which later releases read,
// too.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "coordinator/dds/qos.h"

namespace tcs::record {

struct BagTopic {
  std::string name;               // ROS 2's: "/odom"
  std::string type;               // "nav_msgs/msg/Odometry"
  std::vector<dds::Qos> offered;  // by its writers, each kind once
  std::int64_t messages = 0;
  std::string type_hash = {};  // "RIHS01_...", as its writers or tcs know it; empty: unknown
};

struct BagMetadata {
  std::string file;  // of the messages, relative to the folder
  // The least and the greatest of the messages' stamps; without messages both are 0.
  std::int64_t first_ns = 0, last_ns = 0;
  std::int64_t messages = 0;  // of all topics
  std::vector<BagTopic> topics;
  std::string storage = "sqlite3";  // as rosbag2 calls it
};

// The QoS that the topic's writers offer, as YAML with rmw's numbers for the policies.
[[nodiscard]] std::string OfferedQosYaml(std::span<const dds::Qos> offered);

// The metadata as the database holds them, without the key that the file begins with.
[[nodiscard]] std::string MetadataYaml(const BagMetadata& metadata);
// The metadata as the file holds them.
[[nodiscard]] std::string MetadataFile(const BagMetadata& metadata);

inline constexpr int kMetadataVersion = 5;

}  // namespace tcs::record
