#include "coordinator/gateway/gateway_robot.h"

#include <signal.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "coordinator/channel/dds/ros_nodes.h"
#include "coordinator/dds/ros_names.h"
#include "coordinator/dds/type_hash.h"
#include "coordinator/gateway/served_end.h"

namespace tcs {
namespace {

constexpr const char* kConfiguration = "CYCLONEDDS_URI";
// A sample that readers have yet to acknowledge holds up none of another topic. Histories have
// their depths all the same.
constexpr const char* kNeverHeldUp =
    "<CycloneDDS><Domain><Internal><Watermarks><WhcHigh>1 GB</WhcHigh><WhcHighInit>1 GB"
    "</WhcHighInit><WhcAdaptive>false</WhcAdaptive></Watermarks></Internal></Domain></CycloneDDS>";

const ClientSpec* FirstBySockets(const Scenario& scenario) {
  for (const RobotSpec& robot : scenario.robots) {
    for (const ClientSpec& client : robot.clients) {
      if (client.dds == DdsTransport::kSockets) return &client;
    }
  }
  return nullptr;
}

// Several channels of one topic are one end, which matches the other ends of each.
void Add(gateway::ServedEnd end, std::vector<gateway::ServedEnd>* ends) {
  const auto is_same = [&end](const gateway::ServedEnd& known) {
    return known.is_sensor == end.is_sensor && known.domain == end.domain &&
           known.topic == end.topic;
  };
  const auto known = std::find_if(ends->begin(), ends->end(), is_same);
  if (known == ends->end()) {
    ends->push_back(std::move(end));
    return;
  }
  dds::Qos& qos = known->qos;
  qos.reliability = std::max(qos.reliability, end.qos.reliability);
  qos.durability = std::min(qos.durability, end.qos.durability);
  if (qos.deadline != end.qos.deadline) qos.deadline.reset();
  if (qos.lifespan != end.qos.lifespan) qos.lifespan.reset();
  if (qos.lease != end.qos.lease) qos.lease.reset();
}

std::vector<gateway::ServedEnd> EndsOf(const Scenario& scenario) {
  std::vector<gateway::ServedEnd> ends;
  const auto add = [&](bool is_sensor, const DdsTopicSpec& spec, std::string_view message,
                       std::optional<int> body) {
    Add({.is_sensor = is_sensor,
         .domain = spec.domain,
         .topic = dds::DdsTopic(spec.topic),
         .type = dds::DdsType(message),
         .qos = spec.qos,
         .user_data = dds::UserDataOf(message, scenario.ros),
         .name_space = RosNodes::NamespaceOf(scenario, body)},
        &ends);
  };
  for (const SensorChannelSpec& sensor : scenario.sensors) {
    const auto* to = std::get_if<DdsSensorEnd>(&sensor.to);
    if (to == nullptr) continue;
    const auto body = sensor.bodies.empty() ? std::nullopt : std::optional(sensor.bodies.front());
    add(true, to->end, dds::NameOf(to->message), body);
  }
  for (const CommandChannelSpec& command : scenario.commands) {
    const auto* from = std::get_if<DdsCommandEnd>(&command.from);
    if (from == nullptr) continue;
    const auto body = command.IsOfModel() ? std::nullopt : std::optional(command.body);
    add(false, from->end, dds::NameOf(from->message), body);
  }
  if (scenario.clock) add(true, scenario.clock->end, dds::kClockMessageName, std::nullopt);
  return ends;
}

// The gateway's configuration of Cyclone: that of the programs that the gateway is to meet.
std::string ConfigurationFor(const ClientSpec& client) {
  const auto own = client.environment.find(kConfiguration);
  const char* inherited = getenv(kConfiguration);
  std::string text = own != client.environment.end() ? own->second
                     : inherited != nullptr          ? inherited
                                                     : "";
  if (!text.empty()) text += ',';
  return text + kNeverHeldUp;
}

}  // namespace

std::optional<RobotSpec> GatewayRobot(const Scenario& scenario, const std::string& shim) {
  const ClientSpec* by_sockets = FirstBySockets(scenario);
  if (by_sockets == nullptr || scenario.network) return std::nullopt;
  const std::vector<gateway::ServedEnd> ends = EndsOf(scenario);
  if (ends.empty()) return std::nullopt;
  ClientSpec client;
  client.name = "tcsim/dds_gateway";
  const std::string user_data = dds::UserDataOf(dds::kDiscoveryMessageName, scenario.ros);
  client.command = {std::filesystem::path(shim).replace_filename("tcs-dds-gateway"),
                    scenario.ros == dds::RosRelease::kHumble ? "humble" : "iron",
                    user_data.empty() ? "-" : user_data};
  for (const gateway::ServedEnd& end : ends) client.command.push_back(ToText(end));
  client.working_directory = "/";
  client.environment[kConfiguration] = ConfigurationFor(*by_sockets);
  client.stop_signal = SIGKILL;  // the gateway has nothing to write, and nobody to tell
  RobotSpec robot;
  robot.name = "tcsim";
  robot.clients.push_back(std::move(client));
  robot.is_ideal = robot.is_ours = true;
  return robot;
}

}  // namespace tcs
