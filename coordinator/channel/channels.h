// The open channels of a run, each on the transport that the scenario names.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "coordinator/channel/channel.h"
#include "coordinator/dds/own_endpoints.h"
#include "coordinator/scenario/scenario.h"

namespace tcs {

// What the channels of one kind have in common, if anything.
class Transport {
 public:
  virtual ~Transport() = default;
  // The run begins; virtual CLOCK_REALTIME is so far ahead of virtual time.
  virtual void Begin(VirtualDuration realtime_offset) = 0;
};

struct Channels {
  std::vector<std::unique_ptr<Transport>> transports;  // outlive the rest
  std::vector<std::unique_ptr<Outlet>> outlets;        // of the scenario's sensors, in their order
  std::unique_ptr<Outlet> clock;                       // if the scenario has one
  std::vector<std::unique_ptr<Inlet>> inlets;          // each of one channel or more
  std::vector<Inlet*> inlet_of;                        // the scenario's commands, in their order

  // Claims what the channels need of the host, ports for example. Empty on success, else one
  // sentence. The scenario and the endpoints outlive this.
  [[nodiscard]] std::string Open(const Scenario& scenario, dds::OwnEndpoints& ends);
  void Begin(VirtualDuration realtime_offset);
};

}  // namespace tcs
