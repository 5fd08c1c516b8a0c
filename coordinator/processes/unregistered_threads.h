// Threads that tcs does not manage: of processes that share their parents' memory, or computing on
// after they have said that they end. Such a thread has the level of the thread that made it, and
// virtual time waits for it. But a thread that computes for ever at that level would keep the CPU
// from the dispatched threads. So it loses its level, and virtual time does not wait for it any
// longer.
//
// For the coordinator's thread only. Reads /proc and CPU clocks, and changes levels. Times are of
// the host's processor.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <map>
#include <string>

#include "coordinator/os/strays.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

class UnregisteredThreads {
 public:
  explicit UnregisteredThreads(RunState& run) : run_(run) {}

  // The dispatched thread has not had the host's processor `cpu` for a while. Other threads of the
  // host may have it, too: so an unregistered thread loses its level only if it has computed since
  // the look before, in this dispatch. The threads of `detector` are tcsim's own.
  void LowerThoseThatCompute(int cpu, pid_t detector);
  // The thread loses its level at once.
  void Lower(pid_t tid);
  bool IsLowered(pid_t tid) const { return lowered_.contains(tid); }
  // Whether the thread has lost its level, has had its time since, and is not waited for any more.
  bool IsAstray(pid_t tid) const;

  // A thread of a process that has registered does so itself before it computes anything: true if
  // this thread, which has no slot, never will.
  static bool NeverRegisters(Task& task);

  // Whether virtual time waits since such a thread is at work in a process that has said that it
  // has such threads.
  bool AnyRuns() const;

 private:
  std::string NameOfMakerOf(pid_t tid) const;

  RunState& run_;
  const int most_pids_ = MostPids();
  // Virtual time waits for these threads until their CPU clocks show that.
  std::map<pid_t, std::int64_t> lowered_;
  std::int64_t seen_dispatch_ = -1;             // in which threads were seen last,
  std::map<pid_t, std::int64_t> seen_used_ns_;  // and what they had used by then
};

}  // namespace tcs
