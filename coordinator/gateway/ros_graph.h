// What ROS 2's graph tools are told by sockets: which of the gateway's endpoints belong to which of
// the simulation's nodes, as they are told in shared memory (channel/dds/ros_nodes.h).
#pragma once

#include <string>

#include "coordinator/gateway/half.h"

namespace tcs::gateway {

// In each domain, also to programs that join later. `is_humble`: in the form of ROS 2 Humble.
// `user_data`: of the endpoints that say it.
void AnnounceNodes(const Half& half, bool is_humble, const std::string& user_data);

}  // namespace tcs::gateway
