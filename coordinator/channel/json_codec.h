// The datagrams between a robot's programs and its body: one JSON object each (docs/SCENARIO.md).
//
// Units and frames as in simbody_bridge/dynamics.h: SI, world frame, quaternions x y z w. Pure
// functions: equal input gives equal bytes, whatever the locale.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "shm/virtual_time.h"
#include "simbody_bridge/dynamics.h"

namespace tcs {

struct NamedBodyState {
  std::string_view name;  // UTF-8
  BodyState state;        // finite
};

// {"time":1.23,"frame_id":"world","bodies":{"NAME":{"position":[x,y,z],"orientation":[x,y,z,w],
// "linear_velocity":[x,y,z],"angular_velocity":[x,y,z]}}}: bodies in the order given, time in
// seconds, no line end. Every double reads back as the same double.
[[nodiscard]] std::string EncodeSensorDatagram(VirtualTime time,
                                               std::span<const NamedBodyState> bodies);

struct DecodeError {
  std::string message;  // one sentence for the user; quotes little of the datagram
};

// {"force":[x,y,z],"torque":[x,y,z]}; either may be left out and is zero then. The datagram is
// whatever somebody sent: anything else, numbers that are not finite included, is an error.
[[nodiscard]] std::variant<Wrench, DecodeError> DecodeCommandDatagram(std::string_view datagram);

}  // namespace tcs
