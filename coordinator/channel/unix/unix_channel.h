// Channels of the type unix_json.
#pragma once

#include <cstddef>
#include <vector>

#include "coordinator/channel/channel.h"
#include "coordinator/scenario/scenario.h"

namespace tcs {

Opened<Outlet> OpenUnixOutlet(const UnixName& to, const std::vector<SensorField>& fields);
Opened<Inlet> OpenUnixInlet(const UnixName& from, std::size_t channel);

}  // namespace tcs
