// Terminals, as calls on them wait (termios(3): VMIN and VTIME). Async-signal-safe.
#pragma once

#include <cstdint>

namespace tcs::preload {

bool IsTerminal(int fd);

// How long a read of `fd` that finds nothing waits: 0: not at all; kNeverNs: until something comes,
// as for everything that is no terminal.
std::int64_t ReadTimeoutOf(int fd);

}  // namespace tcs::preload
