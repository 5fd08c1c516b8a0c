// The futex calls that the kernel hands over: all waiting of a process's threads for each other
// ends there. A waiter sleeps to its virtual deadline, and is woken at its waker's virtual time;
// wakes go to the most urgent waiter, among equals to the one that waits longest.
#include <errno.h>
#include <linux/futex.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>

#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"
#include "coordinator/os/trap.h"
#include "shm/time_values.h"

namespace tcs {

namespace {

constexpr std::uint32_t kAnyBit = FUTEX_BITSET_MATCH_ANY;
// How long a joiner gives the kernel to be through with a thread that has ended.
constexpr int kEndTurns = 200;
constexpr useconds_t kEndTurnUs = 50;

// The kernel looks at how many it was to wake only when it has woken one.
int AtLeastOne(std::uint64_t count) { return std::max(1, static_cast<int>(count)); }

}  // namespace

FutexKey Engine::FutexKeyFor(const Task& task, const TrappedCall& call, std::uint64_t address) {
  return KeyOf(task.process->pid, address, (call.args[1] & FUTEX_PRIVATE_FLAG) != 0);
}

// The same for a wake. What a shared address is mapped to takes a look at the process, and where
// nobody waits at the same place of any page, nobody can be woken.
FutexKey Engine::WokenKeyFor(const Process& process, const TrappedCall& call,
                             std::uint64_t address) const {
  const bool is_private = (call.args[1] & FUTEX_PRIVATE_FLAG) != 0;
  return KeyOf(process.pid, address, is_private || !futexes_.MayBeWaitedAt(address));
}

// From an absolute or relative timeout, if the call has one, to a deadline on its virtual CPU.
std::int64_t Engine::FutexDeadline(const Task& task, const TrappedCall& call, int command,
                                   const timespec& timeout, std::int64_t* deadline_ns) {
  *deadline_ns = shm::kNeverNs;
  if (call.args[3] == 0) return 0;
  if (!shm::IsValid(timeout)) return -EINVAL;
  const std::int64_t ns = shm::ToNs(timeout);
  if (ns > shm::kFarNs) return 0;
  const std::int64_t now = task.reached_ns;
  if (command == FUTEX_WAIT) {
    *deadline_ns = now + ns;
    return 0;
  }
  const bool realtime = command == FUTEX_LOCK_PI || (call.args[1] & FUTEX_CLOCK_REALTIME) != 0;
  const std::int64_t offset = realtime ? header_->realtime_offset_ns : header_->monotonic_offset_ns;
  const ProgramTime deadline = OwnTime(ns - offset);
  *deadline_ns = std::max(now, task.process->clock.RobotTimeOf(deadline).ns());
  return 0;
}

std::int64_t Engine::FutexWait(Task& task, const TrappedCall& call, int command) {
  const auto bits = static_cast<std::uint32_t>(call.args[5]);
  std::uint32_t value = 0;
  timespec timeout{};
  const RemotePiece word{call.args[0], &value, sizeof value};
  if (!(call.args[3] == 0
            ? ReadMemory(task.process->pid, word.address, word.to, word.size)
            : ReadMemory(task.process->pid, word, {call.args[3], &timeout, sizeof timeout}))) {
    return -EFAULT;
  }
  std::int64_t deadline_ns = 0;
  if (const auto wrong = FutexDeadline(task, call, command, timeout, &deadline_ns); wrong != 0) {
    return wrong;
  }
  // Nobody has run since the caller looked: this is the check that the kernel makes under its lock.
  if (value != static_cast<std::uint32_t>(call.args[2])) return -EAGAIN;
  if (const pid_t joined = static_cast<pid_t>(value & FUTEX_TID_MASK); IsEnding(task, joined)) {
    // A join: the kernel clears the word when the thread has gone, which it is about to be. If it
    // has gone and the word is still the same, that is only a number like the thread's.
    for (int turn = 0;; ++turn) {
      const char state = ThreadState(joined);
      if (!ReadMemory(task.process->pid, call.args[0], &value, sizeof value)) return -EFAULT;
      if (value != static_cast<std::uint32_t>(call.args[2])) return -EAGAIN;
      if (state == 'X' || state == 'Z' || turn == kEndTurns) break;
      usleep(kEndTurnUs);
    }
  }
  futexes_.Wait(task.order, FutexKeyFor(task, call, call.args[0]),
                command == FUTEX_WAIT ? kAnyBit : bits);
  EnterFutexWait(task, {.names_tid = static_cast<pid_t>(value & FUTEX_TID_MASK)}, deadline_ns);
  return 0;
}

// After the table of futexes knows where.
void Engine::EnterFutexWait(Task& task, awaited::Futex wait, std::int64_t deadline_ns) {
  EnterWait(task, {wait, deadline_ns, true});
}

std::int64_t Engine::FutexWake(const FutexKey& key, std::int64_t most, std::uint32_t bits,
                               Moment moment) {
  std::int64_t woken = 0;
  for (; woken < most; ++woken) {
    Task* best = MostUrgentWaiter(key, bits);
    if (best == nullptr) break;
    best->Awaits<awaited::Futex>()->woken_word = futexes_.IndexOf(best->order, key);
    MakeReady(*best, shm::WakeReason::kGo, moment);
  }
  return woken;
}

std::int64_t Engine::FutexRequeue(const Task& task, const TrappedCall& call, int command) {
  if (command == FUTEX_CMP_REQUEUE) {
    std::uint32_t value = 0;
    if (!ReadMemory(task.process->pid, call.args[0], &value, sizeof value)) return -EFAULT;
    if (value != static_cast<std::uint32_t>(call.args[5])) return -EAGAIN;
  }
  const FutexKey from = FutexKeyFor(task, call, call.args[0]),
                 to = FutexKeyFor(task, call, call.args[4]);
  std::int64_t moved = FutexWake(from, static_cast<int>(call.args[2]), kAnyBit, {task.reached_ns});
  auto most = static_cast<int>(call.args[3]);
  for (const FutexTable::Thread waiter : futexes_.WaitersAt(from)) {
    if (most-- <= 0) break;
    futexes_.Move(waiter, from, to);
    ++moved;
  }
  return moved;
}

std::int64_t Engine::FutexWakeOp(const Task& task, const TrappedCall& call) {
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
  std::int64_t woken = FutexWake(WokenKeyFor(*task.process, call, call.args[0]),
                                 AtLeastOne(call.args[2]), kAnyBit, {task.reached_ns});
  const bool holds[] = {old == against, old != against, old<against, old <= against, old> against,
                        old >= against};
  if (holds[compare]) {
    woken += FutexWake(WokenKeyFor(*task.process, call, call.args[4]), AtLeastOne(call.args[3]),
                       kAnyBit, {task.reached_ns});
  }
  return woken;
}

// FUTEX_WAKE and FUTEX_WAKE_BITSET: the threads woken; none for other commands.
std::int64_t Engine::CarryOutWake(const Process& process, const TrappedCall& call, Moment moment) {
  const int command = static_cast<int>(call.args[1]) & FUTEX_CMD_MASK;
  if (command != FUTEX_WAKE && command != FUTEX_WAKE_BITSET) return 0;
  return FutexWake(WokenKeyFor(process, call, call.args[0]), AtLeastOne(call.args[2]),
                   command == FUTEX_WAKE ? kAnyBit : static_cast<std::uint32_t>(call.args[5]),
                   moment);
}

// The thread has said that it ends, but the kernel may not be through with it yet.
bool Engine::IsEnding(const Task& joiner, pid_t tid) const {
  return std::any_of(table_.tasks().begin(), table_.tasks().end(), [&](const Task& task) {
    return task.tid == tid && task.process == joiner.process && task.state == TaskState::kDead;
  });
}

// A core that is ahead must not wake whom another one may wake, or a deadline end, before. The call
// is made again once that is over.
bool Engine::HoldsToWake(Task& task, const TrappedCall& call, int command) {
  const bool wakes = command == FUTEX_WAKE || command == FUTEX_WAKE_BITSET ||
                     command == FUTEX_WAKE_OP || command == FUTEX_REQUEUE ||
                     command == FUTEX_CMP_REQUEUE || command == FUTEX_CMP_REQUEUE_PI ||
                     command == FUTEX_UNLOCK_PI;
  if (!wakes || IsCallback() || task.reached_ns <= root_.WriteSafe(task.cpu->leaf)) return false;
  // Nobody waits: then nobody can be woken too early.
  if (command != FUTEX_WAKE_OP &&
      MostUrgentWaiter(WokenKeyFor(*task.process, call, call.args[0]), kAnyBit) == nullptr) {
    return false;
  }
  task.early_trap = call;
  task.trap_id = 0;
  waker_.Hold(task, shm::NotificationKind::kWrite);
  return true;
}

void Engine::HandleFutex(Task& task, const TrappedCall& call) {
  const int command = static_cast<int>(call.args[1]) & FUTEX_CMD_MASK;
  task.trap_result = WrongFutexCall(task, call, command);
  if (task.trap_result != 0 || HoldsToWake(task, call, command)) return;
  switch (command) {
    case FUTEX_WAIT:
    case FUTEX_WAIT_BITSET:
      task.trap_result = FutexWait(task, call, command);
      break;
    case FUTEX_WAKE:
    case FUTEX_WAKE_BITSET:
      task.trap_result = CarryOutWake(*task.process, call, {task.reached_ns});
      // Threads that tcs does not know wait in the kernel.
      task.trap_continues =
          task.process->has_unmanaged_threads && task.trap_result < static_cast<int>(call.args[2]);
      break;
    case FUTEX_REQUEUE:
    case FUTEX_CMP_REQUEUE:
      task.trap_result = FutexRequeue(task, call, command);
      break;
    case FUTEX_WAKE_OP:
      task.trap_result = FutexWakeOp(task, call);
      break;
    case FUTEX_LOCK_PI:
    case FUTEX_LOCK_PI2:
    case FUTEX_TRYLOCK_PI:
      task.trap_result = FutexLock(task, call, command);
      break;
    case FUTEX_UNLOCK_PI:
      task.trap_result = FutexUnlock(task, call);
      break;
    case FUTEX_WAIT_REQUEUE_PI:
      task.trap_result = FutexWaitForLock(task, call);
      break;
    case FUTEX_CMP_REQUEUE_PI:
      task.trap_result = FutexRequeueToLock(task, call);
      break;
    default:
      task.trap_result = -ENOSYS;
  }
}

}  // namespace tcs
