// Slurm's commands, as a user types them: there is no other way in that all its releases share.
#pragma once

#include <string>
#include <vector>

namespace tcs {

struct CommandResult {
  bool is_found = true;  // in PATH
  bool succeeded = false;
  std::string out, said;  // stdout, and stderr
};

// Runs the command to its end, for a minute at most. The command gets the signals of the terminal.
// The calling process must be single-threaded.
CommandResult RunSlurmCommand(const std::vector<std::string>& words);

// The sentence out of what a command says on stderr, as "Invalid partition name specified" out of
// "sbatch: error: Batch job submission failed: Invalid partition name specified".
std::string SlurmsReason(const std::string& said);

}  // namespace tcs
