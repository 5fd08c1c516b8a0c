#include "coordinator/calls/futex_arguments.h"

#include <errno.h>
#include <linux/futex.h>

#include "coordinator/port/traps.h"
#include "shm/time_values.h"

namespace tcs {

namespace {

bool HasTimeout(int command) {
  return command == FUTEX_WAIT || command == FUTEX_WAIT_BITSET || command == FUTEX_LOCK_PI ||
         command == FUTEX_LOCK_PI2 || command == FUTEX_WAIT_REQUEUE_PI;
}

bool HasSecondWord(int command) {
  return command == FUTEX_REQUEUE || command == FUTEX_CMP_REQUEUE || command == FUTEX_WAKE_OP;
}

bool Wakes(int command) {
  return command == FUTEX_WAKE || command == FUTEX_WAKE_BITSET || HasSecondWord(command);
}

// 0, or why there can be no futex at the address. A private futex that is only woken is not read.
std::int64_t WrongAddress(const Task& task, std::uint64_t address, bool is_read) {
  if (address % sizeof(std::uint32_t) != 0) return -EINVAL;
  if (static_cast<std::int64_t>(address) < 0) return -EFAULT;
  std::uint32_t word;
  return !is_read || ReadMemory(task.process->pid, address, &word, sizeof word) ? 0 : -EFAULT;
}

}  // namespace

std::int64_t WrongFutexCall(const Task& task, const TrappedCall& call, int command) {
  if (HasTimeout(command) && call.args[3] != 0) {
    timespec timeout{};
    if (!ReadMemory(task.process->pid, call.args[3], &timeout, sizeof timeout)) return -EFAULT;
    if (!shm::IsValid(timeout)) return -EINVAL;
  }
  if ((call.args[1] & FUTEX_CLOCK_REALTIME) != 0 && command != FUTEX_WAIT_BITSET &&
      command != FUTEX_WAIT_REQUEUE_PI && command != FUTEX_LOCK_PI2) {
    return -ENOSYS;
  }
  const bool has_bits = command == FUTEX_WAIT_BITSET || command == FUTEX_WAKE_BITSET;
  if (has_bits && static_cast<std::uint32_t>(call.args[5]) == 0) return -EINVAL;
  const bool requeues = command == FUTEX_REQUEUE || command == FUTEX_CMP_REQUEUE;
  if (requeues && (static_cast<int>(call.args[2]) < 0 || static_cast<int>(call.args[3]) < 0)) {
    return -EINVAL;
  }
  // The kernel looks for the lock's owner first, and finds none at a wrong address.
  if (command == FUTEX_UNLOCK_PI) return 0;
  const bool is_shared = (call.args[1] & FUTEX_PRIVATE_FLAG) == 0;
  if (const auto wrong = WrongAddress(task, call.args[0], Wakes(command) && is_shared);
      wrong != 0) {
    return wrong;
  }
  return HasSecondWord(command) ? WrongAddress(task, call.args[4], requeues && is_shared) : 0;
}

}  // namespace tcs
