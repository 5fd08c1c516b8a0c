// Which of a robot's ready threads run on its cores: the threads of the highest priority, wherever
// there is a core for them; among equals the thread that became ready first, until it waits or is
// rotated behind them (SCHED_FIFO, and SCHED_RR at a quantum's end). A woken thread may go first,
// before its equals, but not before an equal that has gone first and still has its turn.
//
// The cores advance one after the other, so one may be ahead of another, and a ready thread may
// have come further than a core: such a thread runs no earlier than the time that it has come to. A
// thread stays on the core that it runs on while that core has nothing more urgent. Pure: knows
// threads by number, makes no system call, reads no clock. All times are the robot's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "shm/time_kinds.h"

namespace tcs {

class RunQueue {
 public:
  // The higher priority runs first. Fixed priorities and those made of deadlines are in one order.
  using Priority = std::int64_t;
  using Thread = int;
  static constexpr Thread kNobody = -1;
  static constexpr std::uint64_t kEveryCore = ~std::uint64_t{0};

  struct Ready {
    Thread thread;
    Priority priority;
    VirtualTime from;                    // runs no earlier
    std::uint64_t allowed = kEveryCore;  // cores; bit 0 is core 0
    bool first = false;                  // the thread goes before its equals, until it is rotated
  };

  struct Turn {
    Thread thread = kNobody;
    VirtualTime start = VirtualTime::Never();
  };

  explicit RunQueue(std::size_t cores) : on_(cores, kNobody), turns_(cores) {}

  // The thread becomes ready, behind its equals unless it goes first. A thread that is ready
  // already keeps its place.
  void Add(const Ready& ready);
  // The thread is no longer ready. Nothing happens if it was not.
  void Remove(Thread thread);
  // The thread goes behind its equals, as after a yield or a quantum.
  void Rotate(Thread thread);
  // A ready thread moves behind its new equals; for one that is not ready nothing happens.
  void SetPriority(Thread thread, Priority priority);
  // A ready thread may run on other cores, and keeps its place; for one that is not ready nothing
  // happens.
  void SetAllowed(Thread thread, std::uint64_t allowed);
  // The thread has had a turn on the core, and stays there.
  void Ran(std::size_t core, Thread thread) { on_[core] = thread; }

  // Gives each core its next turn, from the progress of each. Needed after every change above.
  void Assign(const std::vector<VirtualTime>& progress);
  // As last assigned.
  const Turn& Next(std::size_t core) const { return turns_[core]; }
  // Whether an equal of the core's thread waits for a core.
  bool HasWaitingEqual(std::size_t core) const;
  // Whether an equal of that thread, which is ready, wants the core: the equal may have the core
  // already.
  bool IsWantedByEqual(std::size_t core, Thread thread) const;
  // From when on a thread that precedes the core's thread wants a core; never: there is none.
  VirtualTime NextToPrecede(std::size_t core) const;
  // Whether a thread of that priority would take the core from its thread if it became ready now,
  // and went before its equals.
  bool YieldsTo(std::size_t core, Priority priority, bool first = true) const;
  std::size_t CountOf(Priority priority) const;

  bool IsReady(Thread thread) const;
  std::size_t size() const { return ready_.size(); }

 private:
  static bool Precedes(const Ready& one, const Ready& other);
  std::vector<Ready>::const_iterator Find(Thread thread) const;
  bool HasTurn(Thread thread) const;
  bool StaysElsewhere(Thread thread, std::size_t core) const;
  void Choose(std::size_t core, VirtualTime progress, bool keep_places);
  void Displace(const std::vector<VirtualTime>& progress);

  std::vector<Ready> ready_;  // most urgent first, equals in the order of their turns
  std::vector<Thread> on_;    // the thread that ran last on each core and has not waited since
  std::vector<Turn> turns_;   // per core
};

}  // namespace tcs
