// The shim's side of what it does for libtcs_dds.so (link.h).
#pragma once

#include "libtcs_preload/dds/link.h"
#include "shm/layout.h"

namespace tcs::preload {

extern const dds::Link kDdsLink;

// The C library's dlsym, for handles of libraries.
void* LookUp(void* library, const char* name);

// The library that knows Cyclone DDS, for processes that are to use it; null: their DDS uses
// sockets. Writes the path, which is next to the shim, into the buffer.
inline constexpr std::size_t kDdsPathSize = 4096;
const char* DdsLibrary(char (&path)[kDdsPathSize]);

// Tells the coordinator that the process's DDS uses sockets all the same. The first reason counts.
void TellOfSockets(shm::WhySockets why);

}  // namespace tcs::preload
