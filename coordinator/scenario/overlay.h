// --overlay FILE: a piece of a scenario, whose values replace values of the scenario file.
//
// An overlay has the scenario's form, but only the keys that are to change. Maps are merged key by
// key. Any other value (a number, a text, a list) replaces the value that is there, and null
// removes it. A robot or client that an overlay names must exist.
//
// Internal to the loader: mistakes are thrown as ScenarioMistake.
#pragma once

#include <string>
#include <vector>

#include "coordinator/scenario/set_option.h"

namespace tcs {

// The settings in the YAML `text` of `file`, one for each value, in their order.
std::vector<Setting> SettingsOfOverlay(const std::string& file, const std::string& text);

}  // namespace tcs
