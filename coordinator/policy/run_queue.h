// Which of a robot's ready threads run on its cores: those of the highest priority, wherever there
// is a core for them; among equals the one that became ready first, until it waits or is rotated
// behind them (SCHED_FIFO, and SCHED_RR at a quantum's end). One that is woken may go first, before
// its equals, but not before one that has gone first and has its turn yet.
//
// The cores advance one after the other, so one may be ahead of another, and a ready thread may
// have come further than a core: it runs no earlier than that. A thread stays on the core that it
// runs on while that core has nothing more urgent. Pure: knows threads by number, makes no system
// call, reads no clock. All times are the robot's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "shm/time_kinds.h"

namespace tcs {

class RunQueue {
 public:
  // Higher runs first. Fixed ones and those made of deadlines are in one order.
  using Priority = std::int64_t;
  using Thread = int;
  static constexpr Thread kNobody = -1;
  static constexpr std::uint64_t kEveryCore = ~std::uint64_t{0};

  struct Ready {
    Thread thread;
    Priority priority;
    VirtualTime from;                    // runs no earlier
    std::uint64_t allowed = kEveryCore;  // cores; bit 0 is core 0
    bool first = false;                  // it goes before its equals, until it is rotated
  };

  struct Turn {
    Thread thread = kNobody;
    VirtualTime start = VirtualTime::Never();
  };

  explicit RunQueue(std::size_t cores) : on_(cores, kNobody), turns_(cores) {}

  // Ready, behind its equals unless it goes first. A thread that is ready already keeps its place.
  void Add(const Ready& ready);
  // No longer ready. Nothing happens if it was not.
  void Remove(Thread thread);
  // Behind its equals, as after a yield or a quantum.
  void Rotate(Thread thread);
  // A ready thread moves behind its new equals; for one that is not ready nothing happens.
  void SetPriority(Thread thread, Priority priority);
  // The same of the cores that it may run on; it keeps its place.
  void SetAllowed(Thread thread, std::uint64_t allowed);
  // The thread has had a turn on the core, and stays there.
  void Ran(std::size_t core, Thread thread) { on_[core] = thread; }

  // Gives each core its next turn, from the progress of each. Needed after every change above.
  void Assign(const std::vector<VirtualTime>& progress);
  // As last assigned.
  const Turn& Next(std::size_t core) const { return turns_[core]; }
  // Whether an equal of the core's thread waits for a core.
  bool HasWaitingEqual(std::size_t core) const;
  // The same of an equal of that thread's, which is ready: that one may have the core already.
  bool IsWantedByEqual(std::size_t core, Thread thread) const;
  // From when on somebody who precedes the core's thread wants a core; never: nobody.
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
  std::vector<Thread> on_;    // who ran last on each core and has not waited since
  std::vector<Turn> turns_;   // per core
};

}  // namespace tcs
