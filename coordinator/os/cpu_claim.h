// Which host CPU a run with real-time priorities takes. Two such coordinators on one CPU would stop
// each other's threads, so a coordinator claims its CPU for as long as it lives. A run without such
// priorities claims none (cpu_share.h).
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "coordinator/os/cpu_register.h"
#include "coordinator/port/unique_fd.h"

namespace tcs {

// The claim is given back when the object is destroyed. The claim of a process that dies lasts for
// as long as there is a copy of the descriptor.
struct CpuClaim {
  int cpu = -1;
  UniqueFd fd;

  CpuClaim() = default;
  CpuClaim(int of_cpu, UniqueFd claim) : cpu(of_cpu), fd(std::move(claim)) {}
  ~CpuClaim();
  CpuClaim(CpuClaim&&) = default;
  CpuClaim& operator=(CpuClaim&&) = default;
};

// The claim that a child of this process makes is this process's, too, from now on: should the
// child be killed, no other run comes to the CPU before this process has cleared it and ends.
void ShareClaimsOfChildren();

// Claims a CPU that no other tcsim has claimed (claim_order.h says which). Where other runs have
// all CPUs that this process may claim, the call waits for one of them. It says on stderr which
// runs have them and how many runs are ahead, again whenever fewer are, and each half minute.
// Without `waits`, it returns the first of these sentences instead. Runs that wait get the CPUs in
// the order in which they came, but a run that is stopped meanwhile holds up nobody. Claims are
// locks on the CPU's folder in /sys, the queue is locks on the folder above (cpu_register.h):
// nothing is left behind. Where these cannot be opened, the CPU is taken unclaimed.
[[nodiscard]] std::variant<CpuClaim, std::string> ClaimCpu(bool waits);

// A claim that was given up for a while, as of a run that is paused: other runs may have the CPU
// until the claim is taken back. The claim outlives this.
class LentCpu {
 public:
  explicit LentCpu(const CpuClaim& claim);
  // Whether this process has the CPU again. Once a call has found another run on the CPU, this
  // process queues for it, in the order in which runs came. To be asked again and again.
  [[nodiscard]] bool TakeBack();
  // Which run has the CPU, in words.
  std::string WhoHasIt() const;

 private:
  const CpuClaim& claim_;
  std::unique_ptr<CpuRegister> others_;  // once this process queues for the CPU
};

// Whether a tcsim has claimed the CPU, also this one. False where that cannot be seen. Cheap, and
// does not sleep: /proc/locks, which says more, is read by stopping everybody's locks.
bool IsClaimed(int cpu);

// The CPU that ClaimCpu tries first, if nobody shares it.
int LastAllowedCpu();

}  // namespace tcs
