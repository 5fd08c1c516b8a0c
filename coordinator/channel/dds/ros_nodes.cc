#include "coordinator/channel/dds/ros_nodes.h"

#include <algorithm>
#include <utility>

#include "coordinator/dds/ros_names.h"
#include "coordinator/dds/type_hash.h"

namespace tcs {
namespace {

constexpr const char* kNode = "tcsim";

}  // namespace

std::string RosNodes::NamespaceOf(const Scenario& scenario, std::optional<int> body) {
  if (!body.has_value()) return "/";
  const auto has_it = [body](const ClientSpec& client) { return client.body == body; };
  for (const RobotSpec& robot : scenario.robots) {
    if (std::any_of(robot.clients.begin(), robot.clients.end(), has_it)) {
      return "/" + dds::RosToken(robot.name);
    }
  }
  return "/";
}

void RosNodes::Add(const dds::OwnEndpoints& ends, dds::OwnEndpoints::Index endpoint,
                   dds::EndpointKind kind, int domain, std::optional<int> body) {
  dds::ParticipantInfo& participant = by_domain_[domain];
  participant.participant = ends.ParticipantOf(endpoint);
  const std::string name_space = NamespaceOf(scenario_, body);
  auto node = std::find_if(participant.nodes.begin(), participant.nodes.end(),
                           [&](const dds::Node& known) { return known.name_space == name_space; });
  if (node == participant.nodes.end()) {
    node = participant.nodes.insert(node, {.name_space = name_space, .name = kNode});
  }
  auto& guids = kind == dds::EndpointKind::kWriter ? node->writers : node->readers;
  guids.push_back(ends.GuidOf(endpoint));
}

void RosNodes::Announce(dds::OwnEndpoints& ends, std::int64_t timestamp_ns) const {
  const auto form =
      scenario_.ros == dds::RosRelease::kHumble ? dds::GidForm::kHumble : dds::GidForm::kIron;
  const dds::Endpoint writer{
      .kind = dds::EndpointKind::kWriter,
      .topic = std::string(dds::kDiscoveryTopic),
      .type = dds::DdsType(dds::kDiscoveryMessageName),
      .keyless = true,
      .qos = {.depth = 1, .durability = dds::Durability::kTransientLocal},
      .user_data = dds::UserDataOf(dds::kDiscoveryMessageName, scenario_.ros)};
  for (const auto& [domain, participant] : by_domain_) {
    ends.Write(ends.Add(writer, domain, 0), dds::EncodeParticipant(participant, form), timestamp_ns,
               0);
  }
}

}  // namespace tcs
