// Files that the program finds under another name: its robot's devices (TCS_ALIASES,
// shm/attach_protocol.h). Async-signal-safe.
#pragma once

namespace tcs::preload {

// The file to be opened for `path`, which is an absolute path as it was written in the scenario, or
// any other: `path` itself.
const char* FileOf(const char* path);

}  // namespace tcs::preload
