// Which threads wait for which kernel objects that cannot be polled (System V IPC, the backlog of a
// listener): the kernel's wait queues. A thread that changes an object wakes all threads that wait
// for it, in the order in which they came. Each woken thread tries again; if the change was not for
// it, it returns to its place in the queue.
//
// Pure: makes no system call. Threads are numbers. Not thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

namespace tcs {

struct KernelObject {
  std::int64_t kind = 0, id = 0;
  bool operator==(const KernelObject&) const = default;
};

class WaitQueues {
 public:
  using Thread = int;

  // The thread, which waits nowhere yet, waits for the object: behind all others, or, if it is back
  // and its last wait was for the same object, where it was before.
  void Wait(Thread thread, const KernelObject& object, bool is_back);
  // The thread waits no longer, and may come back. Nothing happens if it does not wait.
  void Leave(Thread thread);
  // The thread has ended: the next thread with its number has no place in any queue.
  void Forget(Thread thread) { places_.erase(thread); }

  // The waiting threads, in the order in which they came.
  std::vector<Thread> WaitersFor(const KernelObject& object) const;
  // The objects for which a thread waits, each once, ordered by the least number of its waiting
  // threads.
  std::vector<KernelObject> AwaitedObjects() const;

 private:
  struct Place {
    KernelObject object;
    std::uint64_t order = 0;
    bool waits = false;
  };

  std::map<Thread, Place> places_;
  std::uint64_t last_order_ = 0;
};

}  // namespace tcs
