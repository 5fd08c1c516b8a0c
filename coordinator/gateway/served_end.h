// A topic of the scenario's as the gateway serves it, and as it stands on the gateway's command
// line: one argument for each. tcsim writes the arguments, the gateway reads them. Pure.
#pragma once

#include <optional>
#include <string>

#include "coordinator/dds/qos.h"

namespace tcs::gateway {

struct ServedEnd {
  bool is_sensor = false;  // samples go to programs; else they are commands, and come from them
  int domain = 0;
  std::string topic, type;  // DDS's names: "rt/odom", "nav_msgs::msg::dds_::Odometry_"
  dds::Qos qos;             // of the simulation's end
  std::string user_data;    // likewise: "typehash=RIHS01_...;", or empty
  std::string name_space;   // of the node "tcsim" that it belongs to in ROS 2's graph: "/drone"

  friend bool operator==(const ServedEnd&, const ServedEnd&) = default;
};

[[nodiscard]] std::string ToText(const ServedEnd& end);
// None: the text is not what ToText makes.
[[nodiscard]] std::optional<ServedEnd> FromText(const std::string& text);

}  // namespace tcs::gateway
