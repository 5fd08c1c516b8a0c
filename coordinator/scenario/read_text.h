// Internal to the loader: mistakes are thrown as ScenarioMistake.
#pragma once

#include <string>

namespace tcs {

// The text of a file that a person wrote. `of_what` says what the path is to be: "a scenario file".
std::string ReadText(const std::string& path, const char* of_what);

}  // namespace tcs
