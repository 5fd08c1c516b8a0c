// The timers of clients: setitimer, alarm, timerfd and timer_create. A timer that runs out at an
// instant fires there. The rules of one process's timers are ProcessTimers'.
//
// For the coordinator's thread only.
#pragma once

#include <cstdint>

#include "coordinator/calls/timer_signals.h"
#include "coordinator/port/unique_fd.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"
#include "shm/layout.h"

namespace tcs {

class TimerCalls {
 public:
  TimerCalls(RunState& run, Waker& waker, TimerSignals& signals)
      : run_(run), waker_(waker), signals_(signals) {}

  // Does what a notification asks for of a timer of `process`. The asking thread is the process's,
  // or one of its children's, which have its descriptors. True: a timer descriptor was written to.
  bool Handle(Process& process, Task& task, const shm::Notification& note);

  // Ends waits and fires timers of the robot whose deadlines have come. True: a timer descriptor
  // was written to.
  bool FireDue(Robot& robot, VirtualTime now);
  // Timers on processor time run out while their process runs; the process is told at its next
  // dispatch.
  void ExpireCpu(const Task& ran);
  static ProcessTimers::CpuUsed CpuUsedBy(const Task& task);

  // The overruns of the timer's signal that has been accepted last by `now`.
  std::int64_t OverrunsAt(Process& process, std::int64_t id, VirtualTime now) const;

  static void Delete(Process& process, std::int64_t id);
  // A process's timer_create timers end when it executes another program.
  static void DeletePosix(Process& process);
  // The thread to which the process gives this number, by tcsim's number; 0: none.
  static pid_t ThreadNamed(const Process& process, pid_t said);
  // Our copy of a process's descriptor; none if the descriptor is no timer's.
  static UniqueFd DescriptorOf(const Process& process, int number);

 private:
  static void Close(Process& process, std::int64_t id);
  static void DeleteClosed(Process& process);
  static void Create(Task& task, const shm::Notification& note);
  bool BringUpToDate(Process& owner, const Task& asking, std::int64_t id);
  bool Expire(Process& process, VirtualTime now);

  RunState& run_;
  Waker& waker_;
  TimerSignals& signals_;
};

}  // namespace tcs
