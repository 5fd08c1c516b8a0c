// The state of a run, as `tcsim dump` prints it for people.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

namespace tcs {

// `state` has the form that docs/DEBUGGING.md describes: a coordinator's answer, or what was seen
// from outside. Lines are not longer than `columns` (40 at least), unless a single word is. Text
// from programs is made visible.
[[nodiscard]] std::string StateText(const nlohmann::ordered_json& state, std::size_t columns);

}  // namespace tcs
