// Who runs on one virtual CPU: the most urgent ready thread; among equals the one that became ready
// first, until it waits or is rotated behind them (SCHED_FIFO, and SCHED_RR at a quantum's end).
// Pure: knows threads by number, makes no system call, reads no clock.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace tcs {

class FixedPriority {
 public:
  using Thread = int;

  // Ready, behind its equals. A thread that is ready already keeps its place.
  void Add(Thread thread, int priority);
  // No longer ready. Nothing happens if it was not.
  void Remove(Thread thread);
  // Behind its equals, as after a yield or a quantum.
  void Rotate(Thread thread);
  // A ready thread moves behind its new equals; for one that is not ready nothing happens.
  void SetPriority(Thread thread, int priority);

  std::optional<Thread> First() const;
  bool IsReady(Thread thread) const;
  // True if another ready thread has the same priority.
  bool HasEqual(Thread thread) const;
  std::size_t size() const { return ready_.size(); }

 private:
  struct Entry {
    Thread thread;
    int priority;
  };
  std::vector<Entry>::const_iterator Find(Thread thread) const;

  std::vector<Entry> ready_;  // most urgent first, equals in the order of their turns
};

}  // namespace tcs
