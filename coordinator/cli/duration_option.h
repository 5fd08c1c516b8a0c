// Durations on the command line.
#pragma once

#include <optional>
#include <string>

#include "shm/virtual_time.h"

namespace tcs {

// A duration above 0 from the option `--name`; an empty text sets nothing. The sentence, if it is
// not one.
std::string TakeDuration(const std::string& name, const std::string& text,
                         std::optional<VirtualDuration>* to);

}  // namespace tcs
