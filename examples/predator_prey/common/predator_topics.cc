#include "examples/predator_prey/common/predator_topics.h"

#include <stdexcept>

namespace predator_prey {
namespace {

// The ports of higher domains would lie beyond 65535.
constexpr int kHighestDomain = 232;

std::string WhatIsWrongWithNamespace(const std::string& text) {
  constexpr const char* kAllowed =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_/";
  const bool fits = !text.empty() && text.find_first_not_of(kAllowed) == std::string::npos &&
                    text.front() != '/' && text.back() != '/';
  return fits ? "" : "'" + text + "' is no namespace; write one like predator or fleet/predator";
}

template <class Message>
Topic<Message> MakeTopic(const DdsEntity& participant, const dds_topic_descriptor_t& type,
                         const std::string& name_space, const std::string& name) {
  return Topic<Message>(participant, type, "rt/" + name_space + "/" + name);
}

}  // namespace

void AddDdsOptions(CommandLine& command_line, DdsOptions& options) {
  command_line.AddUnlessTold("--domain", options.domain,
                             "DDS domain [that of CYCLONEDDS_URI, or 0, unless told]", 0,
                             kHighestDomain);
  AddNamespace(command_line, "--namespace", options.predator, "namespace of the predator's topics");
}

void AddNamespace(CommandLine& command_line, const char* name, std::string& value,
                  const char* help) {
  command_line.AddText(name, value, help, WhatIsWrongWithNamespace);
}

DdsEntity JoinDomain(const DdsOptions& options) {
  const dds_entity_t participant = dds_create_participant(options.domain, nullptr, nullptr);
  if (participant < 0) {
    throw std::runtime_error(
        "cannot join the DDS domain; Cyclone says why above, and is configured by CYCLONEDDS_URI");
  }
  return DdsEntity(participant, "join the DDS domain");
}

Topic<OdometryMessage> OdometryTopic(const DdsEntity& participant, const std::string& name_space) {
  return MakeTopic<OdometryMessage>(participant, nav_msgs_msg_dds__Odometry__desc, name_space,
                                    "odom");
}

Topic<WrenchMessage> WrenchTopic(const DdsEntity& participant, const std::string& name_space) {
  return MakeTopic<WrenchMessage>(participant, geometry_msgs_msg_dds__Wrench__desc, name_space,
                                  "wrench");
}

Topic<PlanRequestMessage> PlanRequestTopic(const DdsEntity& participant,
                                           const std::string& name_space) {
  return MakeTopic<PlanRequestMessage>(participant, predator_prey_msgs_msg_dds__PlanRequest__desc,
                                       name_space, "plan_request");
}

Topic<PlanMessage> PlanTopic(const DdsEntity& participant, const std::string& name_space) {
  return MakeTopic<PlanMessage>(participant, predator_prey_msgs_msg_dds__Plan__desc, name_space,
                                "plan");
}

}  // namespace predator_prey
