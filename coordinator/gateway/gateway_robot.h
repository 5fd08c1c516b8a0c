// The gateway between the scenario's DDS topics, which are in shared memory, and programs whose DDS
// uses sockets: tcsim's own client, on an ideal robot of its own, so that it takes no virtual time.
// A scenario does not name it, and results do not tell of it.
#pragma once

#include <optional>
#include <string>

#include "coordinator/scenario/scenario.h"

namespace tcs {

// The program is beside the shim, whose absolute path is given. None where no client's DDS uses
// sockets, where there are no such topics, or where robots have hosts of their own, which the
// gateway does not reach.
[[nodiscard]] std::optional<RobotSpec> GatewayRobot(const Scenario& scenario,
                                                    const std::string& shim);

}  // namespace tcs
