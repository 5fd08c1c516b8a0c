// Where the predator's programs meet their robot and each other: the DDS domain, and the topics,
// named and typed as ROS 2 would (`rt/` stands before each of its topics' names).
#pragma once

#include <string>

#include "examples/predator_prey/common/dds_endpoints.h"
#include "examples/predator_prey/common/dds_messages.h"
#include "examples/predator_prey/common/program.h"

namespace predator_prey {

struct DdsOptions {
  dds_domainid_t domain = DDS_DOMAIN_DEFAULT;
  std::string predator = "predator";  // namespace of its topics
};

// --domain and --namespace.
void AddDdsOptions(CommandLine& command_line, DdsOptions& options);

// The option for one ROS 2 namespace.
void AddNamespace(CommandLine& command_line, const char* name, std::string& value,
                  const char* help);

DdsEntity JoinDomain(const DdsOptions& options);

// nav_msgs/Odometry: where a body is and how it moves.
Topic<OdometryMessage> OdometryTopic(const DdsEntity& participant, const std::string& name_space);
// geometry_msgs/Wrench: what acts on a body, in the world's frame, at its centre of mass.
Topic<WrenchMessage> WrenchTopic(const DdsEntity& participant, const std::string& name_space);

Topic<PlanRequestMessage> PlanRequestTopic(const DdsEntity& participant,
                                           const std::string& name_space);
Topic<PlanMessage> PlanTopic(const DdsEntity& participant, const std::string& name_space);

}  // namespace predator_prey
