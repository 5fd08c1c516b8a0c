// `tcsim exec`.
#pragma once

#include <string>
#include <vector>

#include "coordinator/tasks/coordinator.h"

namespace tcs {

struct ExecArguments {
  std::vector<std::string> command;
  double speed = 1.0;  // of each core
  int cores = 1;
  std::string wakeup;  // how long waking a thread takes, such as 50us or 20us,80us; empty: nothing
  std::string costs;   // a file of prices, or none; empty: those that tcs has
  bool patch_vdso = true;
  CycleCounter cycle_counter = CycleCounter::kVirtual;
  std::string call_cost;  // of one call under fixed accounting, such as 100ns; empty: as by default
  std::string allocation_cost;  // of one allocation, the same
  DdsTransport dds = DdsTransport::kEndpoints;
  std::string uptime;  // of the computer when the run begins, such as 20s; empty: as by default
  std::string date;    // when the run begins, such as 2005-03-18; the same
  std::vector<std::string> outside;  // names of what is waited for outside of the run
  std::string outside_takes;         // under fixed accounting; as by default where it is empty
  std::string patience;              // with silence under fixed accounting; the same
};

// Runs the command alone on a computer, without dynamics; the exit status is the command's own.
int ExecCommand(const ExecArguments& arguments, const RunOptions& options);

}  // namespace tcs
