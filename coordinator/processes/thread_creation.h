// How the coordinator comes to know threads and processes: they get their places in the table, on
// their robot and in the records, and wait to be started there.
//
// For the coordinator's thread only. `at` is the virtual time at which the thread can act first.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>

#include "coordinator/processes/run_records.h"
#include "coordinator/scenario/scenario.h"
#include "coordinator/tasks/reactor.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class ThreadCreation {
 public:
  ThreadCreation(RunState& run, Waker& waker, Reactor& reactor, RunRecords& records)
      : run_(run), waker_(waker), reactor_(reactor), records_(records) {}

  // Each function returns the thread that is new, of a process the first one. The reactor watches
  // for the ends of processes (Tag::kProcess, with their indices).
  //
  // A client of the scenario has been started.
  Task& AddClient(pid_t pid, Robot& robot, const ClientSpec& client, VirtualTime at);
  // A process that `maker`, or one of its descendants, has made. The new process is on the maker's
  // robot, and as urgent.
  Task& AddChild(pid_t pid, pid_t parent, const Process& maker, VirtualTime at);
  Task& AddThread(Process& process, pid_t tid, VirtualTime at);

 private:
  Process& AddProcess(pid_t pid, pid_t parent, Robot& robot);
  Task& AddTask(Process& process, pid_t tid, VirtualTime at);

  RunState& run_;
  Waker& waker_;
  Reactor& reactor_;
  RunRecords& records_;
};

}  // namespace tcs
