// A library that the user preloads is meant for programs, not for tcsim itself: a sanitizer's
// runtime would look for leaks in tcsim, and a memory allocator may make threads.
#pragma once

#include <string>

namespace tcs {

// The user's LD_PRELOAD. Where there is one tcsim is executed once more without it; the environment
// has it again when this returns, for the programs that tcsim starts.
std::string TakeUserPreload(char** argv);

}  // namespace tcs
