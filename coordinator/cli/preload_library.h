#pragma once

#include <string>

namespace tcs {

// The shim that belongs to this tcsim: ../lib/libtcs_preload.so beside its own folder.
std::string PreloadLibrary();

// The library that knows Cyclone DDS: the shim loads it into programs that use that.
std::string DdsLibrary();
// The library that charges allocations under fixed accounting, beside the shim.
std::string AllocationLibrary();

}  // namespace tcs
