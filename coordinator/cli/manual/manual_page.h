// A manual page, for man(1).
#pragma once

#include <string>

#include "coordinator/cli/manual/description.h"

namespace tcs {

// The page as the source for man: the page of the program where `parent` is empty, else of one of
// its commands. `all`: the program, for what the page refers to.
[[nodiscard]] std::string ManualPage(const DescribedCommand& command, const std::string& parent,
                                     const DescribedCommand& all, const std::string& version);

}  // namespace tcs
