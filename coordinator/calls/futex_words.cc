#include "coordinator/calls/futex_words.h"

#include <errno.h>
#include <linux/futex.h>
#include <unistd.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "coordinator/port/proc_files.h"
#include "coordinator/port/traps.h"
#include "coordinator/port/waits.h"
#include "shm/time_values.h"

namespace tcs {

namespace {

// How long a joiner gives the kernel to be through with a thread that has ended.
constexpr int kEndTurns = 200;
constexpr HostDuration kEndTurn = HostDuration::Microseconds(50);

constexpr std::uint64_t kMostWords = 128;      // FUTEX_WAITV_MAX
constexpr std::uint32_t kWordOf32Bits = 0x02;  // FUTEX_32, the only size that there is

// Of linux/futex.h since 5.16.
struct WaitedWord {
  std::uint64_t value, address;
  std::uint32_t flags, reserved;
};

}  // namespace

FutexKey FutexWords::KeyFor(const Task& task, const TrappedCall& call, std::uint64_t address) {
  return KeyOf(task.process->pid, address, (call.args[1] & FUTEX_PRIVATE_FLAG) != 0);
}

FutexKey FutexWords::WokenKeyFor(const Process& process, const TrappedCall& call,
                                 std::uint64_t address) const {
  const bool is_private = (call.args[1] & FUTEX_PRIVATE_FLAG) != 0;
  return KeyOf(process.pid, address, is_private || !table_.MayBeWaitedAt(address));
}

bool FutexWords::IsDate(const TrappedCall& call, int command) {
  return command == FUTEX_LOCK_PI ||
         (command != FUTEX_WAIT && (call.args[1] & FUTEX_CLOCK_REALTIME) != 0);
}

std::int64_t FutexWords::Deadline(const Task& task, const TrappedCall& call, int command,
                                  const timespec& timeout, VirtualTime* deadline) {
  *deadline = VirtualTime::Never();
  if (call.args[3] == 0) return 0;
  if (!shm::IsValid(timeout)) return -EINVAL;
  const std::int64_t ns = shm::ToNs(timeout);
  if (ns > shm::kFarNs) return 0;
  const VirtualTime now = task.reached;
  if (command == FUTEX_WAIT) {
    *deadline = now + VirtualNs(ns);
    return 0;
  }
  const std::int64_t offset = run_.OffsetOf(IsDate(call, command));
  *deadline = std::max(now, task.process->clock.RobotTimeOf(OwnTime(ns - offset)));
  return 0;
}

const Task* FutexWords::EndsAt(const Process& process, std::uint64_t address,
                               std::uint32_t value) const {
  const auto named = static_cast<pid_t>(value & FUTEX_TID_MASK);
  const Task* found = nullptr;
  for (const Task& task : run_.table.tasks()) {
    if (task.process != &process) continue;
    if (task.end_word == address) return &task;
    const bool lives = task.state != TaskState::kDead;
    if (task.own_tid == named && (found == nullptr || lives)) found = &task;
  }
  return found;
}

std::int64_t FutexWords::Wait(Task& task, const TrappedCall& call, int command) {
  const auto bits = static_cast<std::uint32_t>(call.args[5]);
  std::uint32_t value = 0;
  timespec timeout{};
  const RemotePiece word{call.args[0], &value, sizeof value};
  if (!(call.args[3] == 0
            ? ReadMemory(task.process->pid, word.address, word.to, word.size)
            : ReadMemory(task.process->pid, word, {call.args[3], &timeout, sizeof timeout}))) {
    return -EFAULT;
  }
  VirtualTime deadline;
  if (const auto wrong = Deadline(task, call, command, timeout, &deadline); wrong != 0) {
    return wrong;
  }
  // No thread has run since the caller looked: this comparison is the check that the kernel makes
  // under its lock.
  if (value != static_cast<std::uint32_t>(call.args[2])) return -EAGAIN;
  const Task* joined = EndsAt(*task.process, call.args[0], value);
  if (joined != nullptr && joined->state == TaskState::kDead) {
    // A join: the thread has said that it ends, and the kernel clears the word when the thread has
    // gone. If the thread has gone and the word is still the same, the word is only a number like
    // the thread's.
    for (int turn = 0;; ++turn) {
      const char state = ThreadState(joined->tid);
      if (!ReadMemory(task.process->pid, call.args[0], &value, sizeof value)) return -EFAULT;
      if (value != static_cast<std::uint32_t>(call.args[2])) return -EAGAIN;
      if (state == 'X' || state == 'Z' || turn == kEndTurns) break;
      Pause(kEndTurn);
    }
  }
  table_.Wait(task.order, KeyFor(task, call, call.args[0]), command == FUTEX_WAIT ? kAnyBit : bits);
  // The owner of a robust lock that processes share may be in another one.
  const auto holds = static_cast<pid_t>(value & FUTEX_TID_MASK);
  if (joined == nullptr) joined = run_.table.Named(*task.process, holds);
  const pid_t names = joined == nullptr ? 0 : joined->tid;
  Enter(task, {.names_tid = names, .address = call.args[0], .holds = holds}, deadline,
        IsDate(call, command));
  return 0;
}

void FutexWords::Enter(Task& task, awaited::Futex wait, VirtualTime deadline, bool is_date) {
  waker_.Wait(task,
              {.what = wait, .deadline = deadline, .is_in_trapped_call = true, .is_date = is_date});
}

// The joiner finds the word as it was: whether the kernel has cleared it is seen when the joiner
// waits again.
void FutexWords::WakeAtEndOf(const Task& ended, EventTime when) {
  constexpr TrappedCall kKernelsWake{.args = {0, FUTEX_WAKE}};
  if (ended.end_word == 0 || ended.process->dead) return;
  Wake(WokenKeyFor(*ended.process, kKernelsWake, ended.end_word), 1, kAnyBit, when);
}

std::int64_t FutexWords::WaitForAny(Task& task, const TrappedCall& call) {
  const std::uint64_t count = static_cast<std::uint32_t>(call.args[1]);
  if (static_cast<std::uint32_t>(call.args[2]) != 0 || count == 0 || count > kMostWords ||
      call.args[0] == 0) {
    return -EINVAL;
  }
  const pid_t pid = task.process->pid;
  timespec timeout{};
  VirtualTime deadline = VirtualTime::Never();
  if (call.args[3] != 0) {
    const auto clock = static_cast<int>(call.args[4]);
    if (clock != CLOCK_MONOTONIC && clock != CLOCK_REALTIME) return -EINVAL;
    if (!ReadMemory(pid, call.args[3], &timeout, sizeof timeout)) return -EFAULT;
    TrappedCall timed = call;  // in the form of FUTEX_WAIT_BITSET
    timed.args[1] = clock == CLOCK_REALTIME ? FUTEX_CLOCK_REALTIME : 0;
    const auto wrong = Deadline(task, timed, FUTEX_WAIT_BITSET, timeout, &deadline);
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
  table_.WaitForAny(task.order, std::move(keys), kAnyBit);
  Enter(task, {}, deadline, call.args[4] == CLOCK_REALTIME);
  return 0;
}

Task* FutexWords::MostUrgent(const FutexKey& key, std::uint32_t bits) {
  const FutexTable::Thread thread = table_.MostUrgent(key, bits);
  return thread == FutexTable::kNobody ? nullptr : &run_.table.At(thread);
}

std::int64_t FutexWords::Wake(const FutexKey& key, std::int64_t most, std::uint32_t bits,
                              EventTime when) {
  std::int64_t woken = 0;
  for (; woken < most; ++woken) {
    Task* best = MostUrgent(key, bits);
    if (best == nullptr) break;
    best->Awaits<awaited::Futex>()->woken_word = table_.IndexOf(best->order, key);
    waker_.Wake(*best, shm::WakeReason::kGo, when);
  }
  return woken;
}

}  // namespace tcs
