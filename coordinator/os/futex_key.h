// Which futex an address of a process is.
#pragma once

#include <sys/types.h>

#include <cstdint>

namespace tcs {

// The properties that make two futex addresses the same: the process and the address, or for memory
// that processes share, the file and the offset.
struct FutexKey {
  pid_t pid = 0;  // 0: shared
  std::uint64_t file = 0, address = 0;
  bool operator==(const FutexKey&) const = default;
};

// Looks at the process's mappings unless the futex is private.
FutexKey KeyOf(pid_t pid, std::uint64_t address, bool is_private);

}  // namespace tcs
