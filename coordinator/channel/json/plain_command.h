// Commands in their usual form, read without a tree of JSON values: a fleet sends thousands of
// these a second.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/model/joint_goal.h"

namespace tcs {

// The wrench that DecodeCommand gives for {"force":[x,y,z],"torque":[x,y,z]}, with any blanks and
// in either order, either key left out. None for any other text, which may be a command all the
// same: an escape in a key, a number beyond doubles.
[[nodiscard]] std::optional<Wrench> ReadPlainCommand(std::string_view text);

// The same for DecodeJointCommand and {"NAME":1.5} for any of `joints`, none of them twice.
[[nodiscard]] std::optional<std::vector<JointGoal>> ReadPlainGoals(
    std::string_view text, std::span<const std::string> joints, JointQuantity quantity);

}  // namespace tcs
