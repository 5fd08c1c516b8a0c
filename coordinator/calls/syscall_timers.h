// Timers whose calls are made raw. These timers are the same as those that the shim makes for its
// program, so a timer made one way can be set the other way.
//
// Results are the kernel's: negative for an errno. For the coordinator's thread only.
#pragma once

#include <time.h>

#include <cstdint>

#include "coordinator/calls/timer_calls.h"
#include "coordinator/port/traps.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

class SyscallTimers {
 public:
  struct Found {
    Process* owner = nullptr;
    std::int64_t id = 0;
  };

  SyscallTimers(RunState& run, TimerCalls& calls) : run_(run), calls_(calls) {}

  // task.trap_result is what the call returns; or the kernel carries it out.
  void Call(Task& task, const TrappedCall& call);
  // The timer of a descriptor, and whose it is: timers made before a fork are the parent's. No
  // owner: the descriptor is no timer's.
  Found Find(const Task& task, int number);

 private:
  static std::int64_t Create(Task& task, const TrappedCall& call);
  static Found Adopt(const Task& task, int number);
  std::int64_t NowOf(const Task& task, const Process& owner, const shm::TimerKind& kind) const;
  itimerspec Exchange(Task& task, const Found& found, bool sets, std::int64_t first_ns,
                      std::int64_t interval_ns, bool is_date = false);
  std::int64_t Set(Task& task, const Found& found, const TrappedCall& call);
  std::int64_t IntervalTimer(Task& task, const TrappedCall& call);
  std::int64_t PosixTimer(Task& task, const TrappedCall& call);

  RunState& run_;
  TimerCalls& calls_;
};

}  // namespace tcs
