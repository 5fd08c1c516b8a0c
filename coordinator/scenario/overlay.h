// --overlay FILE: a piece of a scenario, whose values replace those of the scenario file.
//
// It has the scenario's form, but only the keys that are to be others; maps are gone into, all
// else (numbers, texts, lists) replaces what stands there, and null removes it. What it names, a
// robot or a client, must be there.
//
// Internal to the loader: mistakes are thrown as ScenarioMistake.
#pragma once

#include <string>
#include <vector>

#include "coordinator/scenario/set_option.h"

namespace tcs {

// What the YAML `text` of `file` says, a setting for each value, in their order.
std::vector<Setting> SettingsOfOverlay(const std::string& file, const std::string& text);

}  // namespace tcs
