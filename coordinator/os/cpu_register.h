// The register by which the runs of a machine tell each other which CPUs they wait for and which
// they share: ranges of the folder of all CPUs in /sys, whose locks end with their holder
// (range_locks.h). Every process that sees the same /sys sees the locks, whichever user it is of. A
// process can hold up others by such locks no more than by locking the CPUs' folders themselves
// (cpu_claim.h).
//
//   ticket * 1024 + cpu              the run with this ticket waits for this CPU
//   2^60 + cpu * 2^32 + any number   a run without real-time priorities is on this CPU
//
// A process has one object at a time: closing the object lets go of what any other one has locked.
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

  // This run comes to the end of the queue for one of these CPUs, and stays in the queue until it
  // leaves.
  void Queue(const std::vector<int>& cpus);
  void Leave();
  // The runs that wait before this run, or all that wait if this run does not; first come, first.
  std::vector<WaitingRun> Ahead() const;

  // From now on this run is on the CPU that `choose` names; the run was on another one, perhaps. No
  // other run chooses meanwhile.
  template <typename Choose>
  int Share(const Choose& choose) {
    const RangeLocks::Alone alone(locks_);
    const int cpu = choose();
    ShareAs(cpu);
    return cpu;
  }
  // How many other runs are on the CPU.
  std::size_t SharersOf(int cpu) const;

 private:
  void ShareAs(int cpu);

  RangeLocks locks_;
  std::int64_t ticket_ = -1;     // -1: the run does not wait
  std::int64_t shared_at_ = -1;  // -1: the run is on no CPU
};

}  // namespace tcs
