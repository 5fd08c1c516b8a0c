// The open channels of a run, each on the transport that the scenario names.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "coordinator/channel/channel.h"
#include "coordinator/channel/recorded/channel_records.h"
#include "coordinator/channel/transport.h"
#include "coordinator/dds/own_endpoints.h"
#include "coordinator/scenario/scenario.h"

namespace tcs {

struct Channels {
  std::vector<std::unique_ptr<Transport>> transports;  // outlive the rest
  std::vector<std::unique_ptr<Outlet>> outlets;        // of the scenario's sensors, in their order
  std::unique_ptr<Outlet> clock;                       // if the scenario has one
  std::vector<std::unique_ptr<Inlet>> inlets;          // each of one channel or more
  std::vector<Inlet*> inlet_of;                        // the scenario's commands, in their order

  std::vector<FileAlias> aliases;

  // Claims what the channels need of the host, ports for example. Empty on success, else one
  // sentence. The scenario and the endpoints outlive this.
  [[nodiscard]] std::string Open(const Scenario& scenario, dds::OwnEndpoints& ends,
                                 const MakeAt& make_at);
  // Has the watch, which outlives this, told of datagrams.
  void TellOf(DatagramWatch& watch, const Scenario& scenario);
  // Records what goes over the channels that are not on DDS (DDS records its own messages). Call it
  // after Open, and before any outlet or inlet is given out.
  void Record(const Scenario& scenario, ChannelRecords& records);
  void Begin(VirtualDuration realtime_offset);
};

}  // namespace tcs
