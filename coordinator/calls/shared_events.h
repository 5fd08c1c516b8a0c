// One event, one waiter (queues/one_waiter.h): which descriptors offer the same event, and what the
// kernel has there. The kernel does so, too, with several threads that wait in epoll sets which
// hold the same descriptor with EPOLLEXCLUSIVE; an event that this keeps from the other threads is
// the first thread's for good.
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

  // An event has come for these threads, in one look at the kernel: each thread goes on, or is
  // passed over. True if some are passed over: then the reactor is to look again before anybody
  // acts, because it tells once more of the event that they were passed over for.
  bool Wake(const std::vector<Task*>& awaiters, EventTime when);
  // The thread has tried what it was woken for: the rest is for the next thread.
  void PassOn(Task& first, EventTime when);

 private:
  void PassOver(Task& task, Task& first);

  RunState& run_;
  Waker& waker_;
  Reactor& reactor_;
};

}  // namespace tcs
