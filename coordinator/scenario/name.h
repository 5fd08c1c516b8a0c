// What robots, clients, channels and the like may be called.
#pragma once

#include <string_view>

namespace tcs {

// 1 to 64 letters, digits, '_', '-' and '.', of which the last two do not begin it.
[[nodiscard]] bool IsName(std::string_view text);

}  // namespace tcs
