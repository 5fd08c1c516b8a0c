// One trial's `tcsim run`, as a process of its own.
#pragma once

#include <sched.h>
#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/port/unique_fd.h"

namespace tcs {

struct RunProcessRequest {
  std::vector<std::string> arguments;  // of tcsim
  std::string log;                     // gets its stdout and stderr
  bool own_network = false;
  cpu_set_t cpus;  // that it may use
};

// Ended, if it still lives, in order: by a SIGTERM, also when this process dies.
class RunProcess {
 public:
  // An empty error, or why there is no process. The caller must be the process's only thread.
  static std::string Start(const RunProcessRequest& request, RunProcess* process);

  RunProcess() = default;
  RunProcess(RunProcess&& other) noexcept;
  RunProcess& operator=(RunProcess&& other) noexcept;
  ~RunProcess();

  // Readable once it has ended.
  int pidfd() const { return pidfd_.get(); }
  // How far it says that it is, in virtual time.
  std::int64_t virtual_ns() const;
  void EndInOrder() const;
  // After its end: as of waitpid.
  int Reap();

 private:
  pid_t pid_ = -1;
  UniqueFd pidfd_;
  UniqueFd progress_;  // a file in memory that it writes one number to
};

}  // namespace tcs
