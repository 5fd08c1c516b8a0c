// Threads that the kernel holds, and those that hold them up there because they were preempted in
// it: what they are let do so that all get on.
//
// For the coordinator's thread only. Reads /proc, and changes levels.
#pragma once

#include "coordinator/host/host_cpu.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

class HeldThreads {
 public:
  HeldThreads(RunState& run, HostCpu& cpu) : run_(run), cpu_(cpu) {}

  // The running thread may wait in the kernel for what another one had there when it was preempted:
  // the map of their process's memory, say. That one has to get on with it, and which one it is
  // nobody can see: so those that were preempted in the kernel get the active level in turns, the
  // process's own before others.
  void LendLevel();
  // The others of a process that ends as a whole are at nobody's turn any more, and have to get it
  // over with: one that the kernel kept from its last step, where it removes its entry in /proc,
  // would make whoever reaps the process wait for that in the kernel, spinning, and at a real-time
  // priority for ever.
  void LetDie(const Process& process);
  // The thread is gone, though it said nothing (the first one's pthread_exit, or the system call
  // itself), and its process goes on.
  static bool HasExited(const Task& task);

 private:
  RunState& run_;
  HostCpu& cpu_;
};

}  // namespace tcs
