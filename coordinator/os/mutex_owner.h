// The owner of a mutex of the C library's that other threads wait for.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <optional>

namespace tcs {

// The owner of the mutex that begins at that address of the process, if a mutex does: a thread for
// which `is_thread` holds. A condition or a semaphore has something else there. Reads the process's
// memory.
std::optional<pid_t> OwnerOfMutex(pid_t pid, std::uint64_t address,
                                  const std::function<bool(pid_t)>& is_thread);

}  // namespace tcs
