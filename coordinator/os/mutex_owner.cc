#include "coordinator/os/mutex_owner.h"

#include "coordinator/port/traps.h"

namespace tcs {

namespace {

// The beginning of a mutex of the C library: the word that waiters wait at, how often the mutex is
// locked, and its owner.
struct MutexBegin {
  std::int32_t word, count, owner;
};

}  // namespace

std::optional<pid_t> OwnerOfMutex(pid_t pid, std::uint64_t address,
                                  const std::function<bool(pid_t)>& is_thread) {
  MutexBegin mutex{};
  if (!ReadMemory(pid, address, &mutex, sizeof mutex)) return std::nullopt;
  const bool is_locked = mutex.word == 1 || mutex.word == 2;
  if (!is_locked || mutex.count < 0 || !is_thread(mutex.owner)) return std::nullopt;
  return mutex.owner;
}

}  // namespace tcs
