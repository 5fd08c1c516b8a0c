// Calls that could do something to tcsim's own processes, and that no filter can judge
// (os/protection.h): signals to whole groups, and calls that name a process by a descriptor.
// Clients act as the same user, so the kernel would let them.
//
// For the coordinator's thread only.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "coordinator/port/traps.h"
#include "coordinator/tasks/task.h"

namespace tcs {

class GuardedCalls {
 public:
  // `own`: tcsim's own processes. `is_beside`: whether a process is a broker beside a program; no
  // signal is meant for brokers.
  void Guard(std::vector<pid_t> own, std::function<bool(pid_t)> is_beside) {
    guarded_ = std::move(own);
    is_beside_ = std::move(is_beside);
  }
  const std::vector<pid_t>& guarded() const { return guarded_; }

  // The kernel carries the call out, unless the call is about one of tcsim's own processes. False
  // if the thread has left the call.
  bool LetThrough(const TrappedCall& call) const;
  // The same for the call in which the task has stopped.
  bool Continue(const Task& task) const;

 private:
  bool IsGuarded(pid_t pid) const;
  bool MeansGuarded(pid_t caller, pid_t receiver) const;
  std::int64_t SignalOurs(pid_t caller, pid_t receiver, int signal) const;
  std::optional<std::int64_t> InsteadOfKernel(const TrappedCall& call) const;

  std::vector<pid_t> guarded_;
  std::function<bool(pid_t)> is_beside_;
};

}  // namespace tcs
