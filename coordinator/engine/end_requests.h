// The signals by which a run is asked to end.
#pragma once

#include "coordinator/port/unique_fd.h"
#include "coordinator/tasks/reactor.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

class EndRequests {
 public:
  // The signals are blocked, and kept in a descriptor, which the reactor has. To be called before
  // there are threads, which inherit the signal mask of the thread that creates them.
  void Open(Reactor& reactor);
  bool IsPending() const;
  // The next signal counts for the run. False if there is none, or the signal is for the program
  // that has the terminal.
  bool Take(RunState& run);

 private:
  UniqueFd fd_;
};

}  // namespace tcs
