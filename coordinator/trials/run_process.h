// The `tcsim run` of one trial, as a process of its own.
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
  std::string log;                     // gets the process's stdout and stderr
  bool own_network = false;
  cpu_set_t cpus;  // the CPUs that the process may use
};

// A run's process. The destructor ends it in order, by a SIGTERM, if it still lives; so does the
// end of this process.
class RunProcess {
 public:
  // Returns an empty text, or why there is no process. The calling thread must be its process's
  // only one.
  static std::string Start(const RunProcessRequest& request, RunProcess* process);

  RunProcess() = default;
  RunProcess(RunProcess&& other) noexcept;
  RunProcess& operator=(RunProcess&& other) noexcept;
  ~RunProcess();

  // Readable once the run has ended.
  int pidfd() const { return pidfd_.get(); }
  // How far the run says that it is, in virtual time.
  std::int64_t virtual_ns() const;
  void EndInOrder() const;
  // To be called after the run's end. Returns the status as of waitpid.
  int Reap();

 private:
  pid_t pid_ = -1;
  UniqueFd pidfd_;
  UniqueFd progress_;  // a file in memory that the run writes one number to
};

}  // namespace tcs
