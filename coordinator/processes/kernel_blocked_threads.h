// Threads that the kernel holds, and threads that hold these up because they were preempted inside
// the kernel. The class has such threads run so that all make progress.
//
// For the coordinator's thread only. Reads /proc, and changes levels.
#pragma once

#include "coordinator/host/host_cpu.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

class KernelBlockedThreads {
 public:
  KernelBlockedThreads(RunState& run, HostCpu& cpu) : run_(run), cpu_(cpu) {}

  // The running thread may wait in the kernel for what another thread had there when it was
  // preempted: the map of their process's memory, say. The other thread has to finish, but nobody
  // can see which thread it is. So the threads that were preempted in the kernel get the active
  // level in turns, the threads of the same process first.
  void LendLevel();
  // The other threads of a process that ends as a whole have no turns any more, but have to finish.
  // In its last step a thread removes its entry in /proc. If a thread were kept from that step, the
  // task that reaps the process would wait for it in the kernel, spinning, and at a real-time
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
