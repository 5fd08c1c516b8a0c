// Files in which programs read about their computer, and that the coordinator has made for them:
// how the shim recognises such a file by its descriptor.
#pragma once

namespace tcs::shm {

// Such a file is a memfd with this name, which the path that the program opened follows.
inline constexpr char kComputerFile[] = "tcs:";

}  // namespace tcs::shm
