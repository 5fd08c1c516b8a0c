// The means by which one processor of the host runs some threads and keeps others from running.
//
// The coordinator runs before all of them: what is said here takes effect once it sleeps. A thread
// that is held may still be let run by the kernel, to end or to stop; it executes nothing of its
// program's.
#pragma once

#include <sys/types.h>

namespace tcs {

class Executor {
 public:
  virtual ~Executor() = default;

  // It runs while the coordinator sleeps, unless it waits: at its gate, say.
  virtual void LetRun(pid_t tid) = 0;
  // It does not run, as long as one that may wants to.
  virtual void Hold(pid_t tid) = 0;
  // What the kernel has to do for it is done when this returns: it has stopped, say, or is back in
  // its wait. It is held.
  virtual void LetKernelFinish(pid_t tid) = 0;
  // It is no concern of this processor's until it is held again: another one runs it.
  virtual void LetGo(pid_t) {}

  // True if whoever may run stands still while the coordinator runs. Otherwise it shares the
  // processor with the coordinator and with those that are held, and has to be told to stop.
  virtual bool StandsStill() const { return true; }
};

}  // namespace tcs
