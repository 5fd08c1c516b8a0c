// The scheduler process: keeps every leaf's progress together, dispatches threads on the one CPU
// they share, charges them, and answers what they notify. One object runs one scenario, on the
// calling thread.
#pragma once

#include <string>
#include <vector>

#include "coordinator/core/task.h"
#include "coordinator/core/world.h"

namespace tcs {

struct RunOptions {
  shm::Accounting accounting = shm::Accounting::kMeasured;
  std::string output_directory;  // empty: clients keep the terminal (tcsim exec)
  std::string preload_library;
};

struct ClientReport {
  std::string name;
  std::int64_t charged_ns = 0, host_cpu_ns = 0, stolen_ns = 0, activations = 0;
};

struct RunReport {
  std::string error;    // one sentence; empty if the run went to its end
  int exit_status = 0;  // of the first client, as a shell would report it
  std::int64_t virtual_ns = 0, drift_ns = 0, staleness_ns = 0;
  std::int64_t real_ns = 0, client_ns = 0, dynamics_ns = 0, coordinating_ns = 0;
  std::int64_t switches = 0, samples = 0, commands = 0;
  std::vector<ClientReport> clients;
  std::vector<std::string> warnings;
};

RunReport RunScenario(const Scenario& scenario, const RunOptions& options);

}  // namespace tcs
