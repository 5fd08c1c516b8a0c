// The names that robots, clients, channels and the like may have.
#pragma once

#include <string_view>

namespace tcs {

// True for 1 to 64 letters, digits, '_', '-' and '.', of which the last two do not begin the name.
[[nodiscard]] bool IsName(std::string_view text);

}  // namespace tcs
