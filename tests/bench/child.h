// Running a program for what it prints, however it ends.
#pragma once

#include <string>
#include <vector>

namespace tcs::bench {

struct ChildResult {
  std::string output;  // of stdout
  std::string error;   // one sentence; empty if the program ended with status 0
};

// The program dies with its caller, and after 30 real seconds at the latest. What it says on stderr
// is passed on.
ChildResult RunChild(const std::vector<std::string>& command);

}  // namespace tcs::bench
