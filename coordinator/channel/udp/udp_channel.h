// Channels of the type udp_json.
#pragma once

#include <cstddef>
#include <vector>

#include "coordinator/channel/channel.h"
#include "coordinator/scenario/scenario.h"

namespace tcs {

Opened<Outlet> OpenUdpOutlet(const UdpEndpoint& to, const std::vector<SensorField>& fields);
Opened<Inlet> OpenUdpInlet(const UdpEndpoint& from, std::size_t channel);

}  // namespace tcs
