// The means by which one processor of the host runs some threads and keeps others from running.
//
// The coordinator runs before all of these threads: a call takes effect once the coordinator
// sleeps. The kernel may still let a held thread run, to end or to stop; the thread executes
// nothing of its program then.
#pragma once

#include <sys/types.h>

namespace tcs {

class Executor {
 public:
  virtual ~Executor() = default;

  // The thread runs while the coordinator sleeps, unless the thread waits: at its gate, say.
  virtual void LetRun(pid_t tid) = 0;
  // The thread does not run, as long as another thread that may run wants to.
  virtual void Hold(pid_t tid) = 0;
  // When this returns, the kernel has done what it has to do for the thread: the thread has
  // stopped, say, or is back in its wait. The thread is held.
  virtual void LetKernelFinish(pid_t tid) = 0;
  // The thread is no concern of this processor's until it is held again: another processor runs it.
  virtual void LetGo(pid_t) {}

  // True if a thread that may run stands still while the coordinator runs. Otherwise that thread
  // shares the processor with the coordinator and with held threads, and has to be told to stop.
  virtual bool StandsStill() const { return true; }
};

}  // namespace tcs
