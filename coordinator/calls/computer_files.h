// Opens of the files in which programs read of their computer (computer/computer_file.h): programs
// find their robot's cores in there, and virtual time. An open by whatever means comes here: by a
// raw call, from inside the C library, or by the shim, which makes such opens so that they are
// trapped. A file is made when it is opened, and stays as it was then; the shim opens it once more
// for a program that goes back to its beginning.
//
// For the coordinator's thread only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "coordinator/computer/computer_file.h"
#include "coordinator/computer/processor_folders.h"
#include "coordinator/port/traps.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

class ComputerFiles {
 public:
  explicit ComputerFiles(RunState& run);

  static bool IsOpen(const TrappedCall& call);
  // Whether the file may be one of these. If not, the kernel opens it, and nobody is concerned.
  static bool IsOfComputer(const TrappedCall& call);

  // The thread gets a descriptor, or the kernel's answer.
  void Open(Task& task, const TrappedCall& call);

 private:
  UniqueFd FileFor(const Task& task, const ComputerFile& file, const std::string& name, int flags);
  std::optional<std::string> TextOf(const Task& task, const ComputerFile& file,
                                    const std::string& name) const;
  std::optional<std::string> OfProcess(const Task& task, const ComputerFile& file) const;
  std::string CountersFor(const Task& task) const;
  std::int64_t UptimeNs(const Task& task) const;

  RunState& run_;
  const std::int64_t host_uptime_ns_;                // as the run began
  std::map<std::size_t, ProcessorFolders> folders_;  // by the number of cores
};

}  // namespace tcs
