// The robots' channels on DDS: sensors, the clock, commands (docs/SCENARIO.md), as the
// coordinator's own endpoints.
//
// Stamps are virtual CLOCK_REALTIME. A message goes to the hub at once, and the hub delivers it
// when it is due.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "coordinator/channel/channel.h"
#include "coordinator/channel/dds/ros_nodes.h"
#include "coordinator/channel/transport.h"
#include "coordinator/dds/own_endpoints.h"
#include "coordinator/scenario/scenario.h"

namespace tcs {

class DdsChannels final : public Transport {
 public:
  // None where nothing of the scenario is on DDS. The scenario and the endpoints outlive this.
  static std::unique_ptr<DdsChannels> For(const Scenario& scenario, dds::OwnEndpoints& ends);

  // Announces the scenario's topics.
  void Begin(VirtualDuration realtime_offset) override;

  // This object outlives the outlets and the inlet. The outlet of one of the scenario's sensors:
  std::unique_ptr<Outlet> OutletOf(const SensorChannelSpec& spec);
  // None where the scenario has no clock.
  std::unique_ptr<Outlet> Clock();
  // The inlet of all channels that carry commands on DDS: their samples come in one order.
  std::unique_ptr<Inlet> Commands();

 private:
  class SensorOutlet;
  class ClockOutlet;
  class CommandInlet;
  struct Actuator {
    std::size_t channel;
    const DdsCommandEnd* end;
    dds::OwnEndpoints::Index reader;
  };

  DdsChannels(const Scenario& scenario, dds::OwnEndpoints& ends)
      : scenario_(scenario), ends_(ends), nodes_(scenario) {}
  dds::OwnEndpoints::Index Add(dds::EndpointKind kind, const DdsTopicSpec& end,
                               std::string_view message, std::optional<int> body);
  std::int64_t StampOf(VirtualTime at) const { return (at + realtime_offset_).ns(); }

  const Scenario& scenario_;
  dds::OwnEndpoints& ends_;
  RosNodes nodes_;
  VirtualDuration realtime_offset_;
  std::vector<SensorOutlet*> sensors_;  // in the scenario's order
  std::vector<Actuator> actuators_;
  std::optional<dds::OwnEndpoints::Index> clock_;
};

}  // namespace tcs
