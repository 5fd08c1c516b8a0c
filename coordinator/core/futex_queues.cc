// Futex waits in more than one place: for any of several words (futex_waitv), and at a condition
// whose waker hands its waiters on to a lock (FUTEX_WAIT_REQUEUE_PI, FUTEX_CMP_REQUEUE_PI).
#include <errno.h>
#include <linux/futex.h>
#include <time.h>

#include <algorithm>

#include "coordinator/core/engine.h"

namespace tcs {

namespace {

constexpr std::uint32_t kAnyBit = FUTEX_BITSET_MATCH_ANY;
constexpr std::uint64_t kMostWords = 128;      // FUTEX_WAITV_MAX
constexpr std::uint32_t kWordOf32Bits = 0x02;  // FUTEX_32, the only size that there is

// Of linux/futex.h since 5.16.
struct WaitedWord {
  std::uint64_t value, address;
  std::uint32_t flags, reserved;
};

}  // namespace

bool Engine::WaitsAt(const Task& task, const FutexKey& key) {
  if (task.futexes.empty()) return task.futex == key;
  return std::find(task.futexes.begin(), task.futexes.end(), key) != task.futexes.end();
}

void Engine::NoteWhichFutex(Task& task, const FutexKey& key) {
  const auto found = std::find(task.futexes.begin(), task.futexes.end(), key);
  if (found == task.futexes.end()) return;
  task.woken_futex = static_cast<std::size_t>(found - task.futexes.begin());
}

std::int64_t Engine::FutexWaitForAny(Task& task, const TrappedCall& call) {
  const std::uint64_t count = static_cast<std::uint32_t>(call.args[1]);
  if (static_cast<std::uint32_t>(call.args[2]) != 0 || count == 0 || count > kMostWords ||
      call.args[0] == 0) {
    return -EINVAL;
  }
  const pid_t pid = task.process->pid;
  timespec timeout{};
  if (call.args[3] != 0) {
    const auto clock = static_cast<int>(call.args[4]);
    if (clock != CLOCK_MONOTONIC && clock != CLOCK_REALTIME) return -EINVAL;
    if (!ReadMemory(pid, call.args[3], &timeout, sizeof timeout)) return -EFAULT;
    TrappedCall timed = call;  // in the form of FUTEX_WAIT_BITSET
    timed.args[1] = clock == CLOCK_REALTIME ? FUTEX_CLOCK_REALTIME : 0;
    if (const auto wrong = FutexDeadline(task, timed, FUTEX_WAIT_BITSET, timeout); wrong != 0) {
      return wrong;
    }
  }
  std::vector<WaitedWord> words(count);
  if (!ReadMemory(pid, call.args[0], words.data(), count * sizeof words[0])) return -EFAULT;
  for (const WaitedWord& word : words) {
    if ((word.flags & ~static_cast<std::uint32_t>(FUTEX_PRIVATE_FLAG)) != kWordOf32Bits ||
        word.reserved != 0 || word.address % sizeof(std::uint32_t) != 0) {
      return -EINVAL;
    }
  }
  std::vector<FutexKey> keys;
  for (const WaitedWord& word : words) {
    std::uint32_t value = 0;
    if (!ReadMemory(pid, word.address, &value, sizeof value)) return -EFAULT;
    if (value != static_cast<std::uint32_t>(word.value)) return -EAGAIN;
    keys.push_back(KeyOf(pid, word.address, (word.flags & FUTEX_PRIVATE_FLAG) != 0));
  }
  task.names_tid = 0;
  StartFutexWait(task, keys.front(), kAnyBit);
  task.futexes = std::move(keys);
  return 0;
}

// Like FUTEX_WAIT_BITSET, until somebody hands it on to the lock.
std::int64_t Engine::FutexWaitForLock(Task& task, const TrappedCall& call) {
  if (call.args[0] == call.args[4] || call.args[4] % sizeof(std::uint32_t) != 0) return -EINVAL;
  TrappedCall wait = call;
  wait.args[5] = kAnyBit;
  const std::int64_t result = FutexWait(task, wait, FUTEX_WAIT_BITSET);
  if (result != 0 || task.trap_wait != TrapWait::kFutex) return result;
  task.names_tid = 0;
  task.requeue_to = FutexKeyFor(task, call, call.args[4]);
  task.lock_address = call.args[4];
  return 0;
}

// The most urgent first, of equals those that wait longer.
std::vector<Task*> Engine::WaitersForLock(const FutexKey& key) {
  std::vector<Task*> waiters;
  for (Task& task : tasks_) {
    if (task.trap_wait == TrapWait::kFutex && WaitsAt(task, key)) waiters.push_back(&task);
  }
  std::sort(waiters.begin(), waiters.end(), [](const Task* a, const Task* b) {
    return a->priority != b->priority ? a->priority > b->priority : a->futex_order < b->futex_order;
  });
  return waiters;
}

void Engine::RequeueToLock(Task& waiter, const FutexKey& lock, Task& owner) {
  waiter.requeue_to.reset();
  waiter.was_requeued = true;
  waiter.futex = lock;
  waiter.lock_owner = &owner;
  FindPriority(owner);
}

// The first of the waiters gets the lock, if nobody has it; all others wait for it from now on.
std::int64_t Engine::FutexRequeueToLock(Task& task, const TrappedCall& call) {
  if (static_cast<int>(call.args[2]) != 1 || call.args[0] == call.args[4]) return -EINVAL;
  const auto most = static_cast<int>(call.args[3]);
  if (most < 0) return -EINVAL;
  const pid_t pid = task.process->pid;
  std::uint32_t value = 0, lock = 0;
  if (!ReadMemory(pid, {call.args[0], &value, sizeof value}, {call.args[4], &lock, sizeof lock})) {
    return -EFAULT;
  }
  if (value != static_cast<std::uint32_t>(call.args[5])) return -EAGAIN;
  const FutexKey from = FutexKeyFor(task, call, call.args[0]),
                 to = FutexKeyFor(task, call, call.args[4]);
  const std::vector<Task*> waiters = WaitersForLock(from);
  if (std::any_of(waiters.begin(), waiters.end(),
                  [&](const Task* waiter) { return waiter->requeue_to != to; })) {
    return -EINVAL;
  }
  if (waiters.empty()) return 0;
  const auto owner_tid = static_cast<pid_t>(lock & FUTEX_TID_MASK);
  Task* owner = owner_tid == 0 ? waiters.front() : KnownTask(owner_tid);
  if (owner == nullptr) return -ESRCH;
  const std::size_t count = std::min(waiters.size(), static_cast<std::size_t>(most) + 1);
  const bool queued =
      (owner_tid == 0 ? count > 1 : true) || MostUrgentWaiter(to, kAnyBit) != nullptr;
  lock = (lock & FUTEX_OWNER_DIED) | static_cast<std::uint32_t>(owner->tid) |
         (queued ? FUTEX_WAITERS : 0);
  if (!WriteMemory(pid, call.args[4], &lock, sizeof lock)) return -EFAULT;
  for (std::size_t i = owner_tid == 0 ? 1 : 0; i < count; ++i) {
    RequeueToLock(*waiters[i], to, *owner);
  }
  if (owner_tid == 0) {
    owner->requeue_to.reset();
    owner->handed_lock = owner->lock_address;
    MakeReady(*owner, shm::WakeReason::kGo);
  }
  return static_cast<std::int64_t>(count);
}

}  // namespace tcs
