// Where the runs of a machine tell each other which CPUs they wait for and which they share: ranges
// of the folder of all CPUs in /sys, whose locks end with their holder (range_locks.h). Everybody
// who sees the same /sys sees them, whichever user it is. Nobody can hold up others by them more
// than by locking the CPUs' folders themselves (cpu_claim.h).
//
//   ticket * 1024 + cpu              the run with this ticket waits for this CPU
//   2^60 + cpu * 2^32 + any number   a run without real-time priorities is on this CPU
//
// One object in a process at a time: closing it lets go of what any other one has locked.
#pragma once

#include <cstdint>
#include <vector>

#include "coordinator/os/claim_order.h"
#include "coordinator/os/range_locks.h"

namespace tcs {

class CpuRegister {
 public:
  CpuRegister();
  ~CpuRegister();
  CpuRegister(const CpuRegister&) = delete;
  CpuRegister& operator=(const CpuRegister&) = delete;

  // Comes to the end of those that wait, and stays there, for one of these CPUs, until it leaves.
  void Queue(const std::vector<int>& cpus);
  void Leave();
  // All that wait before this run, or all if it does not wait; first come, first.
  std::vector<WaitingRun> Ahead() const;

  // From now on this run is on the CPU that `choose` names; it was on another one, perhaps. Nobody
  // else chooses meanwhile.
  template <typename Choose>
  int Share(const Choose& choose) {
    const RangeLocks::Alone alone(locks_);
    const int cpu = choose();
    ShareAs(cpu);
    return cpu;
  }
  // How many other runs are on it.
  std::size_t SharersOf(int cpu) const;

 private:
  void ShareAs(int cpu);

  RangeLocks locks_;
  std::int64_t ticket_ = -1;     // -1: it does not wait
  std::int64_t shared_at_ = -1;  // -1: it is nowhere
};

}  // namespace tcs
