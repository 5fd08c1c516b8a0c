// Tells ROS 2's graph tools by sockets which of the gateway's endpoints belong to which of the
// simulation's nodes, as channel/dds/ros_nodes.h tells it in shared memory.
#pragma once

#include <string>

#include "coordinator/gateway/half.h"

namespace tcs::gateway {

// Announces the nodes in each domain, also to programs that join later. `is_humble`: in the form of
// ROS 2 Humble. `user_data`: that of the endpoints that announce them.
void AnnounceNodes(const Half& half, bool is_humble, const std::string& user_data);

}  // namespace tcs::gateway
