// `outside` of a client: what it waits for that is not of the run.
#pragma once

#include <string>

#include "coordinator/scenario/scenario.h"
#include "coordinator/scenario/substitute.h"
#include "coordinator/scenario/yaml_reader.h"

namespace tcs {

// A list of names, or a map of `names`, `takes` and `patience`.
OutsideSpec LoadOutside(const YamlValue& value, const Variables& variables);

// The name as a scenario or a command line has it, relative to a folder: "" if it is one, or what
// it must be.
std::string TakeOutsideName(const std::string& text, const std::string& folder, std::string* name);

}  // namespace tcs
