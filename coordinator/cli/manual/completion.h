// The completions of tcsim's command line for bash and zsh.
#pragma once

#include <string>

#include "coordinator/cli/manual/description.h"

namespace tcs {

[[nodiscard]] std::string BashCompletion(const DescribedCommand& program);
[[nodiscard]] std::string ZshCompletion(const DescribedCommand& program);

}  // namespace tcs
