// Running programs for what they print, however they end.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace tcs::bench {

using Command = std::vector<std::string>;

struct ChildResult {
  std::string output;      // of stdout
  std::string error;       // one sentence; empty if the program ended with status 0
  double cpu_seconds = 0;  // its own and those of the programs that it started and waited for
};

// Other runs of tcsim may have the processors, and are waited for.
inline constexpr std::chrono::seconds kLongestLife{300};

// The program dies with its caller, and after that many real seconds at the latest. What it says on
// stderr is passed on.
ChildResult RunChild(const Command& command, std::chrono::seconds longest = kLongestLife);

// Several at the same time; the results are in the commands' order.
std::vector<ChildResult> RunTogether(const std::vector<Command>& commands,
                                     std::chrono::seconds longest = kLongestLife);

}  // namespace tcs::bench
