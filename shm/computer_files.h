// Files in which programs read of their computer, and that the coordinator has made for them: how
// the shim knows one by its descriptor.
#pragma once

namespace tcs::shm {

// Such a file is memory of this name, and the path follows it that the program opened.
inline constexpr char kComputerFile[] = "tcs:";

}  // namespace tcs::shm
