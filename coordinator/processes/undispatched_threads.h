// Threads that stand where the kernel may let them go on though it is not their turn: their turns
// have ended in the middle of a call, or a signal has come to them whose handler is to run. The
// threads' level keeps them from going on only as long as a thread above that level wants the
// processor. Whenever none does (the kernel holds the dispatched thread, the coordinator waits for
// the disk) they would go on, for as long as that takes the host.
//
// Under set costs each such thread is told by a signal to go to its gate (in the shim,
// preemption.h): when the thread comes to run, it does so before it executes anything of its
// program's. At its dispatch it goes on from there, or, if it has not run until then, from where it
// stands. Without levels, engine/gate_keeper.h does it.
//
// For the coordinator's thread only. Reads /proc.
#pragma once

#include "coordinator/port/proc_files.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

class UndispatchedThreads {
 public:
  explicit UndispatchedThreads(RunState& run) : run_(run) {}

  // The thread's turn ends now.
  void TurnEnds(Task& task);
  // A signal is there for the thread, which has these sets. Threads are told only of signals that
  // were sent to them, not of signals for their processes.
  void SignalCame(Task& task, const SignalSets& sets);
  // The thread has notified that it goes to its gate. True if that is all there is to it.
  bool WentToGate(Task& task);

 private:
  bool MayBeTold(const Task& task) const;

  RunState& run_;
};

}  // namespace tcs
