// The one place that knows all transports.
#include "coordinator/channel/channels.h"

#include <utility>
#include <variant>

#include "coordinator/channel/dds/dds_channels.h"
#include "coordinator/channel/udp/udp_channel.h"

namespace tcs {

std::string Channels::Open(const Scenario& scenario, dds::OwnEndpoints& ends) {
  std::unique_ptr<DdsChannels> dds = DdsChannels::For(scenario, ends);
  for (const SensorChannelSpec& spec : scenario.sensors) {
    if (const auto* to = std::get_if<UdpEndpoint>(&spec.to)) {
      auto outlet = UdpOutlet::Open(*to);
      if (auto* error = std::get_if<SocketError>(&outlet)) return error->message;
      outlets.push_back(std::move(std::get<std::unique_ptr<Outlet>>(outlet)));
    } else {
      outlets.push_back(dds->OutletOf(spec));
    }
  }
  std::unique_ptr<Inlet> dds_commands = dds == nullptr ? nullptr : dds->Commands();
  for (std::size_t i = 0; i < scenario.commands.size(); ++i) {
    if (const auto* from = std::get_if<UdpEndpoint>(&scenario.commands[i].from)) {
      auto inlet = UdpInlet::Open(*from, i);
      if (auto* error = std::get_if<SocketError>(&inlet)) return error->message;
      inlets.push_back(std::move(std::get<std::unique_ptr<Inlet>>(inlet)));
      inlet_of.push_back(inlets.back().get());
    } else {
      inlet_of.push_back(dds_commands.get());
    }
  }
  if (dds == nullptr) return {};
  clock = dds->Clock();
  inlets.push_back(std::move(dds_commands));
  transports.push_back(std::move(dds));
  return {};
}

void Channels::Begin(VirtualDuration realtime_offset) {
  for (const auto& transport : transports) transport->Begin(realtime_offset);
}

}  // namespace tcs
