// Waits at futex words, and wakes there, of which all futex commands are made. A waiter sleeps to
// its virtual deadline, and is woken at its waker's virtual time; wakes go to the most urgent
// waiter, among equals to the one that waits longest.
//
// Results are the kernel's: negative for an errno. For the coordinator's thread only.
#pragma once

#include <linux/futex.h>
#include <time.h>

#include <cstdint>

#include "coordinator/port/traps.h"
#include "coordinator/queues/futex_table.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class FutexWords {
 public:
  // A wake without a set of bits wakes whoever waits.
  static constexpr std::uint32_t kAnyBit = FUTEX_BITSET_MATCH_ANY;

  FutexWords(RunState& run, Waker& waker) : run_(run), waker_(waker) {}

  // FUTEX_WAIT and FUTEX_WAIT_BITSET; futex_waitv.
  std::int64_t Wait(Task& task, const TrappedCall& call, int command);
  std::int64_t WaitForAny(Task& task, const TrappedCall& call);
  // A wait begins; the table knows already at which word.
  void Enter(Task& task, awaited::Futex wait, VirtualTime deadline, bool is_date);
  // Wakes at most `most` threads that wait with one of the bits in `bits`. Returns how many.
  std::int64_t Wake(const FutexKey& key, std::int64_t most, std::uint32_t bits, EventTime when);

  // The wake that the kernel makes at a thread's end, at the word that it clears then.
  void WakeAtEndOf(const Task& ended, EventTime when);

  // Null: no thread waits there.
  Task* MostUrgent(const FutexKey& key, std::uint32_t bits);
  // Whether the call's timeout is a date.
  static bool IsDate(const TrappedCall& call, int command);
  // Converts an absolute or relative timeout, if the call has one, to a deadline on the thread's
  // virtual CPU. 0, or the call's error.
  std::int64_t Deadline(const Task& task, const TrappedCall& call, int command,
                        const timespec& timeout, VirtualTime* deadline);
  static FutexKey KeyFor(const Task& task, const TrappedCall& call, std::uint64_t address);
  // The same for a wake. To find out what a shared address is mapped to takes a look at the
  // process. Where no thread waits at the same place of any page, there is none to wake, and that
  // look is spared.
  FutexKey WokenKeyFor(const Process& process, const TrappedCall& call,
                       std::uint64_t address) const;

  FutexTable& table() { return table_; }

 private:
  // The thread of the process at whose end the kernel changes this word; null: none is known. The
  // word is the one that the kernel clears then, or one that holds the thread's id: a robust lock,
  // or the cleared word where the kernel does not tell its address.
  const Task* EndsAt(const Process& process, std::uint64_t address, std::uint32_t value) const;

  RunState& run_;
  Waker& waker_;
  FutexTable table_{[this](int order) { return PriorityOf(run_.table.At(order)); }};
};

}  // namespace tcs
