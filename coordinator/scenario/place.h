// Where something of a scenario was written.
#pragma once

#include <string>

namespace tcs {

struct Place {
  std::string source;  // the file, or the option that replaces something in it
  int line = 0;        // of the file, from 1; 0: an option has none

  bool IsOption() const { return line == 0; }
  // The beginning of a sentence: "FILE:LINE: " or "--set KEY=VALUE: ".
  std::string Prefix() const {
    return IsOption() ? source + ": " : source + ":" + std::to_string(line) + ": ";
  }
  // How a sentence refers to another place: "on line 7" or "by --set KEY=VALUE".
  std::string Reference() const {
    return IsOption() ? "by " + source : "on line " + std::to_string(line);
  }
};

}  // namespace tcs
