// One event, one waiter (queues/one_waiter.h): which descriptors offer the same event, and what the
// kernel has there. So does the kernel with several threads that wait in epoll sets which hold the
// same descriptor with EPOLLEXCLUSIVE; what that keeps from the others is the first one's for good.
//
// A thread that has taken something says so, if others were passed over for it (kPassOn). For the
// coordinator's thread only.
#pragma once

#include <vector>

#include "coordinator/tasks/event_time.h"
#include "coordinator/tasks/reactor.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class SharedEvents {
 public:
  SharedEvents(RunState& run, Waker& waker, Reactor& reactor)
      : run_(run), waker_(waker), reactor_(reactor) {}

  // The threads for which an event has come, in one look at the kernel: they go on, or are passed
  // over. True if some are: then the reactor is to look again before anybody acts, for it tells of
  // what they were passed over for once more.
  bool Wake(const std::vector<Task*>& awaiters, EventTime when);
  // The thread has tried what it was woken for: what it has left is for the next.
  void PassOn(Task& first, EventTime when);

 private:
  void PassOver(Task& task, Task& first);

  RunState& run_;
  Waker& waker_;
  Reactor& reactor_;
};

}  // namespace tcs
