#include "coordinator/calls/futex_calls.h"

#include <errno.h>
#include <linux/futex.h>

#include <algorithm>

#include "coordinator/calls/futex_arguments.h"

namespace tcs {

namespace {

// The kernel looks at how many threads it was to wake only when it has woken one.
int AtLeastOne(std::uint64_t count) { return std::max(1, static_cast<int>(count)); }

// Commands by which the kernel changes a word, as that of a lock, which programs change, too, by
// themselves.
bool ChangesWord(int command) {
  return command == FUTEX_WAKE_OP || command == FUTEX_LOCK_PI || command == FUTEX_LOCK_PI2 ||
         command == FUTEX_TRYLOCK_PI || command == FUTEX_UNLOCK_PI ||
         command == FUTEX_WAIT_REQUEUE_PI || command == FUTEX_CMP_REQUEUE_PI;
}

}  // namespace

std::int64_t FutexCalls::Requeue(const Task& task, const TrappedCall& call, int command) {
  if (command == FUTEX_CMP_REQUEUE) {
    std::uint32_t value = 0;
    if (!ReadMemory(task.process->pid, call.args[0], &value, sizeof value)) return -EFAULT;
    if (value != static_cast<std::uint32_t>(call.args[5])) return -EAGAIN;
  }
  const FutexKey from = FutexWords::KeyFor(task, call, call.args[0]),
                 to = FutexWords::KeyFor(task, call, call.args[4]);
  std::int64_t moved =
      words_.Wake(from, static_cast<int>(call.args[2]), FutexWords::kAnyBit, {task.reached});
  auto most = static_cast<int>(call.args[3]);
  for (const FutexTable::Thread waiter : words_.table().WaitersAt(from)) {
    if (most-- <= 0) break;
    words_.table().Move(waiter, from, to);
    ++moved;
  }
  return moved;
}

std::int64_t FutexCalls::WakeOp(const Task& task, const TrappedCall& call) {
  const auto operation = static_cast<std::uint32_t>(call.args[5]);
  const std::uint32_t kind = operation >> 28 & 7u, compare = operation >> 24 & 15u;
  auto operand = static_cast<std::int32_t>(operation << 8) >> 20;
  const std::int32_t against = static_cast<std::int32_t>(operation << 20) >> 20;
  if ((operation >> 31) != 0) operand = static_cast<std::int32_t>(1u << (operand & 31));
  if (kind > FUTEX_OP_XOR || compare > FUTEX_OP_CMP_GE) return -ENOSYS;
  const pid_t pid = task.process->pid;
  std::int32_t old = 0;
  if (!ReadMemory(pid, call.args[4], &old, sizeof old)) return -EFAULT;
  const auto sum = static_cast<std::int32_t>(static_cast<std::uint32_t>(old) +
                                             static_cast<std::uint32_t>(operand));
  const std::int32_t results[] = {operand, sum, old | operand, old & ~operand, old ^ operand};
  if (!WriteMemory(pid, call.args[4], &results[kind], sizeof old)) return -EFAULT;
  std::int64_t woken = words_.Wake(words_.WokenKeyFor(*task.process, call, call.args[0]),
                                   AtLeastOne(call.args[2]), FutexWords::kAnyBit, {task.reached});
  const bool holds[] = {old == against, old != against, old<against, old <= against, old> against,
                        old >= against};
  if (holds[compare]) {
    woken += words_.Wake(words_.WokenKeyFor(*task.process, call, call.args[4]),
                         AtLeastOne(call.args[3]), FutexWords::kAnyBit, {task.reached});
  }
  return woken;
}

std::int64_t FutexCalls::CarryOutWake(const Process& process, const TrappedCall& call,
                                      EventTime when) {
  const int command = static_cast<int>(call.args[1]) & FUTEX_CMD_MASK;
  if (command != FUTEX_WAKE && command != FUTEX_WAKE_BITSET) return 0;
  return words_.Wake(
      words_.WokenKeyFor(process, call, call.args[0]), AtLeastOne(call.args[2]),
      command == FUTEX_WAKE ? FutexWords::kAnyBit : static_cast<std::uint32_t>(call.args[5]), when);
}

// A core that is ahead must not wake a thread that another core may wake, or whose wait a deadline
// may end, before. The call is made again once that is over.
bool FutexCalls::HoldsToWake(Task& task, const TrappedCall& call, int command) {
  const bool wakes = command == FUTEX_WAKE || command == FUTEX_WAKE_BITSET ||
                     command == FUTEX_WAKE_OP || command == FUTEX_REQUEUE ||
                     command == FUTEX_CMP_REQUEUE || command == FUTEX_CMP_REQUEUE_PI ||
                     command == FUTEX_UNLOCK_PI;
  if (!wakes || run_.IsCallback() || task.reached <= run_.root.WriteSafe(task.cpu->leaf))
    return false;
  // No thread waits, so none can be woken too early.
  if (command != FUTEX_WAKE_OP &&
      words_.MostUrgent(words_.WokenKeyFor(*task.process, call, call.args[0]),
                        FutexWords::kAnyBit) == nullptr) {
    return false;
  }
  task.early_trap = call;
  task.trap_id = 0;
  waker_.Hold(task, shm::NotificationKind::kWrite);
  return true;
}

void FutexCalls::Handle(Task& task, const TrappedCall& call) {
  const int command = static_cast<int>(call.args[1]) & FUTEX_CMD_MASK;
  task.trap_result = WrongFutexCall(task, call, command);
  if (task.trap_result != 0 || HoldsToWake(task, call, command)) return;
  if (ChangesWord(command)) {
    const bool is_shared = (static_cast<int>(call.args[1]) & FUTEX_PRIVATE_FLAG) == 0;
    stands_still_(is_shared ? nullptr : task.process);
  }
  switch (command) {
    case FUTEX_WAIT:
    case FUTEX_WAIT_BITSET:
      task.trap_result = words_.Wait(task, call, command);
      break;
    case FUTEX_WAKE:
    case FUTEX_WAKE_BITSET:
      task.trap_result = CarryOutWake(*task.process, call, {task.reached});
      // Threads that tcs does not know wait in the kernel.
      task.trap_continues = task.process->has_unregistered_threads &&
                            task.trap_result < static_cast<int>(call.args[2]);
      break;
    case FUTEX_REQUEUE:
    case FUTEX_CMP_REQUEUE:
      task.trap_result = Requeue(task, call, command);
      break;
    case FUTEX_WAKE_OP:
      task.trap_result = WakeOp(task, call);
      break;
    case FUTEX_LOCK_PI:
    case FUTEX_LOCK_PI2:
    case FUTEX_TRYLOCK_PI:
      task.trap_result = locks_.Lock(task, call, command);
      break;
    case FUTEX_UNLOCK_PI:
      task.trap_result = locks_.Unlock(task, call);
      break;
    case FUTEX_WAIT_REQUEUE_PI:
      task.trap_result = locks_.WaitAtCondition(task, call);
      break;
    case FUTEX_CMP_REQUEUE_PI:
      task.trap_result = locks_.RequeueFromCondition(task, call);
      break;
    default:
      task.trap_result = -ENOSYS;
  }
}

}  // namespace tcs
