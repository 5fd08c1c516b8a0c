// The fields of ROS 2's messages, in ROS 2's own words. Comments are left out.
#pragma once

#include <span>
#include <string_view>

namespace tcs::dds {

struct MessageFields {
  std::string_view type;  // "geometry_msgs/Vector3"
  std::string_view text;  // as in its .msg file: a line for each constant and each field
};

// The types that tcs speaks, and the types that these consist of, as of Iron. A field's type
// without a package is of the message's own package.
std::span<const MessageFields> KnownMessages();

// The same, for the messages by which ROS 2's middleware tells of nodes (ros_names.h,
// kDiscoveryMessageName), which are in no recording.
std::span<const MessageFields> DiscoveryMessages();

}  // namespace tcs::dds
