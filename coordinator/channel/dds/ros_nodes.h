// What ROS 2's graph tools are told of the simulation's own endpoints, on `ros_discovery_info`: to
// which node each belongs. The endpoints of a robot belong to the node /ROBOT/tcsim; endpoints of
// bodies that no robot's client has, and the clock's, belong to the node /tcsim.
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

  // An endpoint that has to do with the body, if with any; an index into the world's.
  void Add(const dds::OwnEndpoints& ends, dds::OwnEndpoints::Index endpoint, dds::EndpointKind kind,
           int domain, std::optional<int> body);

  // Of the node to which an endpoint belongs that has to do with the body.
  static std::string NamespaceOf(const Scenario& scenario, std::optional<int> body);

  // Announces them in each domain, also to programs that join later. `timestamp_ns` is DDS's source
  // timestamp.
  void Announce(dds::OwnEndpoints& ends, std::int64_t timestamp_ns) const;

 private:
  const Scenario& scenario_;
  std::map<int, dds::ParticipantInfo> by_domain_;
};

}  // namespace tcs
