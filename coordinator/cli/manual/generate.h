// `tcsim generate FOLDER`, which the build runs: not for people, and so not among the commands that
// `tcsim --help` shows.
#pragma once

#include <string>

#include "coordinator/cli/manual/description.h"

namespace tcs {

// Writes tcsim.1 and a page for each command, and the completions tcsim (bash) and _tcsim (zsh).
// The exit status.
int Generate(const DescribedCommand& program, const std::string& folder);

}  // namespace tcs
