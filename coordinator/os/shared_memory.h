// Memory that is shared with clients by its descriptor: it has no name, nobody who has it can make
// it shorter or longer, so that no access to it fails, and its pages cost nothing until they are
// used.
#pragma once

#include <cstddef>

#include "coordinator/port/unique_fd.h"

namespace tcs {

struct SharedMemory {
  UniqueFd fd;         // none: errno is set
  void* at = nullptr;  // where this process can read and write it
};

// Whoever has the descriptor can write it.
SharedMemory MakeSharedMemory(const char* name, std::size_t size);

// Only this process can write it, through this mapping; whoever has the descriptor reads it.
SharedMemory MakePublishedMemory(const char* name, std::size_t size);

}  // namespace tcs
