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

std::int64_t Engine::FutexWaitForAny(Task& task, const TrappedCall& call) {
  const std::uint64_t count = static_cast<std::uint32_t>(call.args[1]);
  if (static_cast<std::uint32_t>(call.args[2]) != 0 || count == 0 || count > kMostWords ||
      call.args[0] == 0) {
    return -EINVAL;
  }
  const pid_t pid = task.process->pid;
  timespec timeout{};
  std::int64_t deadline_ns = shm::kNeverNs;
  if (call.args[3] != 0) {
    const auto clock = static_cast<int>(call.args[4]);
    if (clock != CLOCK_MONOTONIC && clock != CLOCK_REALTIME) return -EINVAL;
    if (!ReadMemory(pid, call.args[3], &timeout, sizeof timeout)) return -EFAULT;
    TrappedCall timed = call;  // in the form of FUTEX_WAIT_BITSET
    timed.args[1] = clock == CLOCK_REALTIME ? FUTEX_CLOCK_REALTIME : 0;
    const auto wrong = FutexDeadline(task, timed, FUTEX_WAIT_BITSET, timeout, &deadline_ns);
    if (wrong != 0) return wrong;
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
  futexes_.WaitForAny(task.order, std::move(keys), kAnyBit);
  EnterFutexWait(task, {}, deadline_ns);
  return 0;
}

// Like FUTEX_WAIT_BITSET, until somebody hands it on to the lock.
std::int64_t Engine::FutexWaitForLock(Task& task, const TrappedCall& call) {
  if (call.args[0] == call.args[4] || call.args[4] % sizeof(std::uint32_t) != 0) return -EINVAL;
  TrappedCall wait = call;
  wait.args[5] = kAnyBit;
  const std::int64_t result = FutexWait(task, wait, FUTEX_WAIT_BITSET);
  auto* entered = task.Awaits<awaited::Futex>();
  if (result != 0 || entered == nullptr) return result;
  *entered = {.lock_address = call.args[4]};
  futexes_.ExpectLock(task.order, FutexKeyFor(task, call, call.args[4]));
  return 0;
}

void Engine::RequeueToLock(Task& waiter, const FutexKey& lock, Task& owner) {
  futexes_.Move(waiter.order, FutexKey(futexes_.WordOf(waiter.order)), lock);
  waiter.Awaits<awaited::Futex>()->was_requeued = true;
  BlockOn(waiter, &owner);
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
  const std::vector<FutexTable::Thread> waiters = futexes_.ByUrgency(from);
  if (std::any_of(waiters.begin(), waiters.end(),
                  [&](FutexTable::Thread waiter) { return futexes_.ExpectedLock(waiter) != to; })) {
    return -EINVAL;
  }
  if (waiters.empty()) return 0;
  const auto owner_tid = static_cast<pid_t>(lock & FUTEX_TID_MASK);
  Task* owner = owner_tid == 0 ? &TaskAt(waiters.front()) : KnownTask(owner_tid);
  if (owner == nullptr) return -ESRCH;
  const std::size_t count = std::min(waiters.size(), static_cast<std::size_t>(most) + 1);
  const bool queued =
      (owner_tid == 0 ? count > 1 : true) || MostUrgentWaiter(to, kAnyBit) != nullptr;
  lock = (lock & FUTEX_OWNER_DIED) | static_cast<std::uint32_t>(owner->tid) |
         (queued ? FUTEX_WAITERS : 0);
  if (!WriteMemory(pid, call.args[4], &lock, sizeof lock)) return -EFAULT;
  for (std::size_t i = owner_tid == 0 ? 1 : 0; i < count; ++i) {
    RequeueToLock(TaskAt(waiters[i]), to, *owner);
  }
  if (owner_tid == 0) {
    owner->handed_lock = owner->Awaits<awaited::Futex>()->lock_address;
    MakeReady(*owner, shm::WakeReason::kGo, {task.reached_ns});
  }
  return static_cast<std::int64_t>(count);
}

}  // namespace tcs
