// Memory that is shared with clients by its descriptor: the memory has no name, no process that has
// the descriptor can make it shorter or longer, so that no access to it fails, and its pages cost
// nothing until they are used.
#pragma once

#include <cstddef>

#include "coordinator/port/unique_fd.h"

namespace tcs {

struct SharedMemory {
  UniqueFd fd;         // none: errno is set
  void* at = nullptr;  // where this process can read and write it
};

// A process that has the descriptor can write the memory.
SharedMemory MakeSharedMemory(const char* name, std::size_t size);

// Only this process can write the memory, through this mapping; a process that has the descriptor
// reads it.
SharedMemory MakePublishedMemory(const char* name, std::size_t size);

}  // namespace tcs
