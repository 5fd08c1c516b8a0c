// Durations on the command line.
#pragma once

#include <optional>
#include <string>

#include "shm/virtual_time.h"

namespace tcs {

enum class Zero { kRefused, kAllowed };

// Takes a duration above 0, or one of 0 where that is allowed, from the option `--name`; an empty
// text sets nothing. Returns the sentence if the text is no such duration.
std::string TakeDuration(const std::string& name, const std::string& text,
                         std::optional<VirtualDuration>* to, Zero zero = Zero::kRefused);

}  // namespace tcs
