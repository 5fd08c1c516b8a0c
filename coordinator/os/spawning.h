// How clients are started.
#pragma once

#include <sys/types.h>

#include <map>
#include <string>
#include <vector>

#include "coordinator/os/own_computer.h"
#include "coordinator/os/trap.h"
#include "coordinator/port/unique_fd.h"

namespace tcs {

// The errno by which the kernel refuses SpawnRequest::fixed_layout; 0 if the kernel does not
// refuse, or gives all processes the same layout.
int WhyNoFixedLayout();

struct SpawnRequest {
  std::vector<std::string> command;
  std::string working_directory;  // empty: unchanged
  std::map<std::string, std::string> environment;
  std::string log_stdout, log_stderr;     // empty: inherited
  bool fixed_layout = false;              // no address-space randomisation
  std::vector<pid_t> guarded;             // processes that the client is not to touch
  TrappedToo trapped_too;                 // (trap.h)
  const OwnComputer* computer = nullptr;  // null: the host
};

struct Spawned {
  pid_t pid = -1;  // -1: errno is set
  // Where the futex calls of the process arrive, and those of all that it starts; none: nowhere,
  // errno says why.
  UniqueFd trap;
};

// The new process, at Level::kWaiting on the coordinator's CPU, killed with the coordinator.
Spawned Spawn(const SpawnRequest& request);

}  // namespace tcs
