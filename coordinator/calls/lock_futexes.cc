#include "coordinator/calls/lock_futexes.h"

#include <errno.h>
#include <linux/futex.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace tcs {

namespace {

constexpr std::uint32_t kOwner = FUTEX_TID_MASK, kDied = FUTEX_OWNER_DIED, kWaiters = FUTEX_WAITERS;

}  // namespace

std::int64_t LockFutexes::Lock(Task& task, const TrappedCall& call, int command) {
  const pid_t pid = task.process->pid;
  std::uint32_t value = 0;
  if (!ReadMemory(pid, call.args[0], &value, sizeof value)) return -EFAULT;
  const auto owner_tid = static_cast<pid_t>(value & kOwner);
  // A signal may have ended the thread's wait when the thread already had the lock; then the kernel
  // makes the call again.
  const bool has_it_now = std::exchange(task.handed_lock, 0) == call.args[0];
  if (owner_tid == task.own_tid) return has_it_now ? 0 : -EDEADLK;
  const FutexKey key = FutexWords::KeyFor(task, call, call.args[0]);
  if (owner_tid == 0) {
    const bool others = words_.MostUrgent(key, FUTEX_BITSET_MATCH_ANY) != nullptr;
    value = (value & kDied) | static_cast<std::uint32_t>(task.own_tid) | (others ? kWaiters : 0);
    return WriteMemory(pid, call.args[0], &value, sizeof value) ? 0 : -EFAULT;
  }
  if (command == FUTEX_TRYLOCK_PI) return -EAGAIN;
  Task* owner = run_.table.Named(*task.process, owner_tid);
  if (owner == nullptr) return -ESRCH;
  timespec timeout{};
  if (call.args[3] != 0 && !ReadMemory(pid, call.args[3], &timeout, sizeof timeout)) return -EFAULT;
  VirtualTime deadline;
  if (const auto wrong = words_.Deadline(task, call, command, timeout, &deadline); wrong != 0) {
    return wrong;
  }
  value |= kWaiters;
  if (!WriteMemory(pid, call.args[0], &value, sizeof value)) return -EFAULT;
  words_.table().Wait(task.order, key, FUTEX_BITSET_MATCH_ANY);
  words_.Enter(task, {.owner = owner->order, .lock_address = call.args[0]}, deadline,
               FutexWords::IsDate(call, command));
  PriorityInheritance::BlockOn(task, owner);
  inheritance_.Find(*owner);
  return 0;
}

// The lock goes to the most urgent waiter; `flags` goes with it.
bool LockFutexes::HandOn(const FutexKey& key, std::uint32_t flags, EventTime when) {
  Task* next = words_.MostUrgent(key, FUTEX_BITSET_MATCH_ANY);
  if (next == nullptr) return false;
  const awaited::Futex wait = *next->Awaits<awaited::Futex>();
  PriorityInheritance::BlockOn(*next, nullptr);
  next->handed_lock = wait.lock_address;
  words_.table().Leave(next->order);
  const bool others = words_.MostUrgent(key, FUTEX_BITSET_MATCH_ANY) != nullptr;
  const std::uint32_t value =
      static_cast<std::uint32_t>(next->own_tid) | flags | (others ? kWaiters : 0);
  WriteMemory(next->process->pid, wait.lock_address, &value, sizeof value);
  for (const FutexTable::Thread waiter : words_.table().WaitersAt(key)) {
    PriorityInheritance::BlockOn(run_.table.At(waiter), next);
  }
  waker_.Wake(*next, shm::WakeReason::kGo, when);
  if (wait.owner != awaited::kNobody) inheritance_.Find(run_.table.At(wait.owner));
  inheritance_.Find(*next);
  return true;
}

std::int64_t LockFutexes::Unlock(Task& task, const TrappedCall& call) {
  std::uint32_t value = 0;
  task.handed_lock = 0;
  if (!ReadMemory(task.process->pid, call.args[0], &value, sizeof value)) return -EFAULT;
  if (static_cast<pid_t>(value & kOwner) != task.own_tid) return -EPERM;
  if (HandOn(FutexWords::KeyFor(task, call, call.args[0]), 0, {task.reached})) return 0;
  value = 0;
  return WriteMemory(task.process->pid, call.args[0], &value, sizeof value) ? 0 : -EFAULT;
}

void LockFutexes::WakeThoseWaitingFor(Task& ended, EventTime when) {
  words_.WakeAtEndOf(ended, when);
  for (Task& task : run_.table.tasks()) {
    const auto* wait = task.Awaits<awaited::Futex>();
    if (wait == nullptr) continue;
    if (wait->owner == ended.order) {
      HandOn(FutexKey(words_.table().WordOf(task.order)), kDied, when);
    } else if (wait->names_tid == ended.tid) {
      waker_.Wake(task, shm::WakeReason::kGo, when);
    }
  }
}

// Like FUTEX_WAIT_BITSET, until another thread hands the waiting thread on to the lock.
std::int64_t LockFutexes::WaitAtCondition(Task& task, const TrappedCall& call) {
  if (call.args[0] == call.args[4] || call.args[4] % sizeof(std::uint32_t) != 0) return -EINVAL;
  TrappedCall wait = call;
  wait.args[5] = FUTEX_BITSET_MATCH_ANY;
  const std::int64_t result = words_.Wait(task, wait, FUTEX_WAIT_BITSET);
  auto* entered = task.Awaits<awaited::Futex>();
  if (result != 0 || entered == nullptr) return result;
  *entered = {.lock_address = call.args[4]};
  words_.table().ExpectLock(task.order, FutexWords::KeyFor(task, call, call.args[4]));
  return 0;
}

void LockFutexes::Requeue(Task& waiter, const FutexKey& lock, Task& owner) {
  words_.table().Move(waiter.order, FutexKey(words_.table().WordOf(waiter.order)), lock);
  waiter.Awaits<awaited::Futex>()->was_requeued = true;
  PriorityInheritance::BlockOn(waiter, &owner);
  inheritance_.Find(owner);
}

// The first of the waiters gets the lock, if no thread has it; all other waiters wait for the lock
// from now on.
std::int64_t LockFutexes::RequeueFromCondition(Task& task, const TrappedCall& call) {
  if (static_cast<int>(call.args[2]) != 1 || call.args[0] == call.args[4]) return -EINVAL;
  const auto most = static_cast<int>(call.args[3]);
  if (most < 0) return -EINVAL;
  const pid_t pid = task.process->pid;
  std::uint32_t value = 0, lock = 0;
  if (!ReadMemory(pid, {call.args[0], &value, sizeof value}, {call.args[4], &lock, sizeof lock})) {
    return -EFAULT;
  }
  if (value != static_cast<std::uint32_t>(call.args[5])) return -EAGAIN;
  const FutexKey from = FutexWords::KeyFor(task, call, call.args[0]),
                 to = FutexWords::KeyFor(task, call, call.args[4]);
  const std::vector<FutexTable::Thread> waiters = words_.table().ByUrgency(from);
  if (std::any_of(waiters.begin(), waiters.end(), [&](FutexTable::Thread waiter) {
        return words_.table().ExpectedLock(waiter) != to;
      })) {
    return -EINVAL;
  }
  if (waiters.empty()) return 0;
  const auto owner_tid = static_cast<pid_t>(lock & FUTEX_TID_MASK);
  Task* owner =
      owner_tid == 0 ? &run_.table.At(waiters.front()) : run_.table.Named(*task.process, owner_tid);
  if (owner == nullptr) return -ESRCH;
  const std::size_t count = std::min(waiters.size(), static_cast<std::size_t>(most) + 1);
  const bool queued = (owner_tid == 0 ? count > 1 : true) ||
                      words_.MostUrgent(to, FUTEX_BITSET_MATCH_ANY) != nullptr;
  lock = (lock & FUTEX_OWNER_DIED) | static_cast<std::uint32_t>(owner->own_tid) |
         (queued ? FUTEX_WAITERS : 0);
  if (!WriteMemory(pid, call.args[4], &lock, sizeof lock)) return -EFAULT;
  for (std::size_t i = owner_tid == 0 ? 1 : 0; i < count; ++i) {
    Requeue(run_.table.At(waiters[i]), to, *owner);
  }
  if (owner_tid == 0) {
    owner->handed_lock = owner->Awaits<awaited::Futex>()->lock_address;
    waker_.Wake(*owner, shm::WakeReason::kGo, {task.reached});
  }
  return static_cast<std::int64_t>(count);
}

}  // namespace tcs
