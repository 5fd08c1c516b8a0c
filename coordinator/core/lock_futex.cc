// Priority-inheritance futexes (FUTEX_LOCK_PI and its kin): the word holds the owner's thread id;
// who waits lends the owner its priority, and an unlock hands the lock on.
#include <errno.h>
#include <linux/futex.h>

#include <algorithm>
#include <utility>

#include "coordinator/core/engine.h"

namespace tcs {

namespace {

constexpr std::uint32_t kOwner = FUTEX_TID_MASK, kDied = FUTEX_OWNER_DIED, kWaiters = FUTEX_WAITERS;

}  // namespace

Task* Engine::MostUrgentWaiter(const FutexKey& key, std::uint32_t bits) {
  const FutexTable::Thread thread = futexes_.MostUrgent(key, bits);
  return thread == FutexTable::kNobody ? nullptr : &TaskAt(thread);
}

std::int64_t Engine::FutexLock(Task& task, const TrappedCall& call, int command) {
  const pid_t pid = task.process->pid;
  std::uint32_t value = 0;
  if (!ReadMemory(pid, call.args[0], &value, sizeof value)) return -EFAULT;
  const auto owner_tid = static_cast<pid_t>(value & kOwner);
  // A signal may have ended its wait when it already had the lock; then the kernel calls again.
  const bool has_it_now = std::exchange(task.handed_lock, 0) == call.args[0];
  if (owner_tid == task.tid) return has_it_now ? 0 : -EDEADLK;
  const FutexKey key = FutexKeyFor(task, call, call.args[0]);
  if (owner_tid == 0) {
    const bool others = MostUrgentWaiter(key, FUTEX_BITSET_MATCH_ANY) != nullptr;
    value = (value & kDied) | static_cast<std::uint32_t>(task.tid) | (others ? kWaiters : 0);
    return WriteMemory(pid, call.args[0], &value, sizeof value) ? 0 : -EFAULT;
  }
  if (command == FUTEX_TRYLOCK_PI) return -EAGAIN;
  Task* owner = KnownTask(owner_tid);
  if (owner == nullptr) return -ESRCH;
  timespec timeout{};
  if (call.args[3] != 0 && !ReadMemory(pid, call.args[3], &timeout, sizeof timeout)) return -EFAULT;
  std::int64_t deadline_ns = 0;
  if (const auto wrong = FutexDeadline(task, call, command, timeout, &deadline_ns); wrong != 0) {
    return wrong;
  }
  value |= kWaiters;
  if (!WriteMemory(pid, call.args[0], &value, sizeof value)) return -EFAULT;
  futexes_.Wait(task.order, key, FUTEX_BITSET_MATCH_ANY);
  EnterFutexWait(task, {.lock_address = call.args[0]}, deadline_ns);
  BlockOn(task, owner);
  FindPriority(*owner);
  return 0;
}

// The lock goes to the most urgent waiter; `flags` goes with it.
bool Engine::HandLockOn(const FutexKey& key, std::uint32_t flags, Moment moment) {
  Task* next = MostUrgentWaiter(key, FUTEX_BITSET_MATCH_ANY);
  if (next == nullptr) return false;
  const awaited::Futex wait = *next->Awaits<awaited::Futex>();
  BlockOn(*next, nullptr);
  next->handed_lock = wait.lock_address;
  futexes_.Leave(next->order);
  const bool others = MostUrgentWaiter(key, FUTEX_BITSET_MATCH_ANY) != nullptr;
  const std::uint32_t value =
      static_cast<std::uint32_t>(next->tid) | flags | (others ? kWaiters : 0);
  WriteMemory(next->process->pid, wait.lock_address, &value, sizeof value);
  for (const FutexTable::Thread waiter : futexes_.WaitersAt(key)) {
    BlockOn(TaskAt(waiter), next);
  }
  MakeReady(*next, shm::WakeReason::kGo, moment);
  if (wait.owner != awaited::kNobody) FindPriority(TaskAt(wait.owner));
  FindPriority(*next);
  return true;
}

std::int64_t Engine::FutexUnlock(Task& task, const TrappedCall& call) {
  std::uint32_t value = 0;
  task.handed_lock = 0;
  if (!ReadMemory(task.process->pid, call.args[0], &value, sizeof value)) return -EFAULT;
  if (static_cast<pid_t>(value & kOwner) != task.tid) return -EPERM;
  if (HandLockOn(FutexKeyFor(task, call, call.args[0]), 0, {task.reached_ns})) return 0;
  value = 0;
  return WriteMemory(task.process->pid, call.args[0], &value, sizeof value) ? 0 : -EFAULT;
}

// Whoever waits for the thread to end, or for a lock that it held, goes on: the kernel's own wake
// does not reach them.
void Engine::WakeThoseWaitingFor(Task& ended, Moment moment) {
  for (Task& task : table_.tasks()) {
    const auto* wait = task.Awaits<awaited::Futex>();
    if (wait == nullptr) continue;
    if (wait->owner == ended.order) {
      HandLockOn(FutexKey(futexes_.WordOf(task.order)), kDied, moment);
    } else if (wait->names_tid == ended.tid) {
      MakeReady(task, shm::WakeReason::kGo, moment);
    }
  }
}

}  // namespace tcs
