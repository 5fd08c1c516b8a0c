// The signals by which a run is asked to end.
#pragma once

#include "coordinator/port/unique_fd.h"
#include "coordinator/tasks/reactor.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

class EndRequests {
 public:
  // They are blocked, and kept in a descriptor, which the reactor has. Before there are threads,
  // which have the mask of whoever makes them.
  void Open(Reactor& reactor);
  bool IsPending() const;
  // The next one counts for the run. False if there is none, or it is for the program that has the
  // terminal.
  bool Take(RunState& run);

 private:
  UniqueFd fd_;
};

}  // namespace tcs
