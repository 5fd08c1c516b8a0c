// Commands as nearly everybody writes them, read without a tree of JSON values: a fleet sends
// thousands of these a second.
#pragma once

#include <optional>
#include <string_view>

#include "simbody_bridge/dynamics.h"

namespace tcs {

// What DecodeCommand gives for {"force":[x,y,z],"torque":[x,y,z]}, with any blanks and in either
// order, either left out. None for all that is written otherwise, which may be a command all the
// same: an escape in a key, a number beyond doubles.
[[nodiscard]] std::optional<Wrench> ReadPlainCommand(std::string_view text);

}  // namespace tcs
