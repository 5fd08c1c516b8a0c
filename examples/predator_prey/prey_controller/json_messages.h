// The datagrams between the prey's robot and its controller: one JSON object each, as
// docs/SCENARIO.md describes them.
//
// The decoder returns nothing for text that is not the message it expects: a datagram can come from
// anywhere, so a bad one is to be ignored, not to be died of.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "examples/predator_prey/common/body_state.h"

namespace predator_prey {

// Robot → controller: both bodies as they were at `time_s`.
struct SensorReading {
  double time_s = 0.0;
  BodyState predator;
  BodyState prey;
};

std::optional<SensorReading> DecodeSensorReading(std::string_view text);

std::string EncodeCommand(const Wrench& command);

}  // namespace predator_prey
