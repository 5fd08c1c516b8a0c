// `outside` of a client: the things outside of the run that the client waits for.
#pragma once

#include <string>

#include "coordinator/scenario/scenario.h"
#include "coordinator/scenario/substitute.h"
#include "coordinator/scenario/yaml_reader.h"

namespace tcs {

// A list of names, or a map of `names`, `takes` and `patience`.
OutsideSpec LoadOutside(const YamlValue& value, const Variables& variables);

// Takes the name as a scenario or a command line has it, relative to a folder. Returns "" if `text`
// is a name, or what a name must be.
std::string TakeOutsideName(const std::string& text, const std::string& folder, std::string* name);

}  // namespace tcs
