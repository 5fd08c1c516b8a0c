// Tells ROS 2's graph tools, on `ros_discovery_info`, to which node each of the simulation's own
// endpoints belongs. The endpoints of a robot belong to the node /ROBOT/tcsim; endpoints of bodies
// that no robot's client has, and the clock's, belong to the node /tcsim.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "coordinator/dds/own_endpoints.h"
#include "coordinator/dds/participant_info.h"
#include "coordinator/scenario/scenario.h"

namespace tcs {

class RosNodes {
 public:
  // The scenario outlives this.
  explicit RosNodes(const Scenario& scenario) : scenario_(scenario) {}

  // Adds an endpoint that has to do with `body`, if with any; `body` is an index into the world's
  // bodies.
  void Add(const dds::OwnEndpoints& ends, dds::OwnEndpoints::Index endpoint, dds::EndpointKind kind,
           int domain, std::optional<int> body);

  // The namespace of the node to which an endpoint belongs that has to do with the body.
  static std::string NamespaceOf(const Scenario& scenario, std::optional<int> body);

  // Announces the nodes in each domain, also to programs that join later. `timestamp_ns` is DDS's
  // source timestamp.
  void Announce(dds::OwnEndpoints& ends, std::int64_t timestamp_ns) const;

 private:
  const Scenario& scenario_;
  std::map<int, dds::ParticipantInfo> by_domain_;
};

}  // namespace tcs
