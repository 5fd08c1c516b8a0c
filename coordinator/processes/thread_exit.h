// How threads and processes end: their usage is kept, what they held is given up, and others are
// told.
//
// For the coordinator's thread only. Times are virtual nanoseconds.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "coordinator/host/host_cpu.h"
#include "coordinator/processes/usage_book.h"
#include "coordinator/tasks/event_time.h"
#include "coordinator/tasks/process_link.h"
#include "coordinator/tasks/reactor.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class ThreadExit {
 public:
  // Other parts that keep something for threads and processes. All functions must be set.
  struct Listeners {
    // The thread is running, or was right now: it is to be charged up to here.
    std::function<void(Task&)> settle;
    // The thread ends: events that were to come to it go to others. The thread may still wait.
    std::function<void(Task&, EventTime)> thread_ends;
    // The thread has ended: nothing is kept for it any more.
    std::function<void(Task&)> thread_has_ended;
    // The kernel's own wake does not reach the threads that wait for the thread's end, or for a
    // lock of the thread's.
    std::function<void(Task&, EventTime)> wake_those_waiting_for;
    std::function<void(Process& parent, pid_t child, EventTime)> child_has_ended;
    // After the process's threads, and after the process's parent was told.
    std::function<void(Process&, EventTime)> process_has_ended;
  };

  ThreadExit(RunState& run, Waker& waker, Reactor& reactor, HostCpu& cpu, const UsageBook& usage)
      : run_(run), waker_(waker), reactor_(reactor), cpu_(cpu), usage_(usage) {}
  void Tell(Listeners listeners) { listeners_ = std::move(listeners); }

  // The thread is gone, or is about to; its number may be another's already.
  void End(Task& task, EventTime when);
  // Only the coordinator can tell the threads that wait for the thread.
  void EndAndWake(Task& task, EventTime when);

  // The process has ended, as the kernel says.
  void ProcessEnded(std::uint32_t index, EventTime when);
  // A thread that executes another program becomes its process's first one; the other threads have
  // ended, and no other event says so. False if they have not: then the thread has executed
  // nothing.
  bool EndThreadsLostInExec(pid_t pid, EventTime when);

  // Between two steps of the loop: slots of processes that have ended can be read until then.
  void DropLinks() { ended_links_.clear(); }

 private:
  void EndThreadsOf(const Process& process, const Task* except, EventTime when);
  void Reap(Process& process);
  void TellOfRefusal(const Process& process) const;

  RunState& run_;
  Waker& waker_;
  Reactor& reactor_;
  HostCpu& cpu_;
  const UsageBook& usage_;
  Listeners listeners_;
  std::vector<std::unique_ptr<ProcessLink>> ended_links_;
};

}  // namespace tcs
