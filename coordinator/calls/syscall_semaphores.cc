#include "coordinator/calls/syscall_semaphores.h"

#include <sys/ipc.h>
#include <sys/sem.h>

#include <optional>
#include <vector>

#include "coordinator/port/traps.h"

namespace tcs {

namespace {

constexpr std::size_t kMostOperations = 500;  // the kernel's SEMOPM

union Argument {  // of semctl, which no header defines
  semid_ds* status;
  unsigned short* values;
};

std::optional<std::vector<unsigned short>> ValuesOf(int id) {
  semid_ds status{};
  Argument argument{.status = &status};
  if (semctl(id, 0, IPC_STAT, argument) < 0) return std::nullopt;
  std::vector<unsigned short> values(status.sem_nsems);
  argument.values = values.data();
  if (semctl(id, 0, GETALL, argument) < 0) return std::nullopt;
  return values;
}

}  // namespace

bool AreSemaphores(int id) {
  semid_ds status{};
  return semctl(id, 0, IPC_STAT, Argument{.status = &status}) >= 0;
}

bool WouldWaitForSemaphores(const Task& task, const TrappedCall& call) {
  const std::uint64_t count = call.args[2];
  if (count == 0 || count > kMostOperations) return false;
  std::vector<sembuf> operations(count);
  if (!ReadMemory(task.process->pid, call.args[1], operations.data(),
                  operations.size() * sizeof operations[0])) {
    return false;
  }
  const auto values = ValuesOf(static_cast<int>(call.args[0]));
  if (!values.has_value()) return false;
  std::vector<int> after(values->begin(), values->end());
  for (const sembuf& operation : operations) {
    if (operation.sem_num >= after.size()) return false;
    int& value = after[operation.sem_num];
    const bool waits = operation.sem_op == 0 ? value != 0 : value + operation.sem_op < 0;
    if (waits) return (operation.sem_flg & IPC_NOWAIT) == 0;
    value += operation.sem_op;
  }
  return false;
}

}  // namespace tcs
