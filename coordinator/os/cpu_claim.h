// Which host CPU a run with real-time priorities takes. Two such coordinators on one CPU would stop
// each other's threads, so each claims its CPU for as long as it lives. A run without them claims
// none (cpu_share.h).
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "coordinator/os/cpu_register.h"
#include "coordinator/port/unique_fd.h"

namespace tcs {

// Given back when it is destroyed. A process that dies with it holds it for as long as there is a
// copy of the descriptor.
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
// child be killed, nobody else comes to the CPU before this process has cleared it and ends.
void ShareClaimsOfChildren();

// A CPU that no other tcsim has claimed (claim_order.h says which). Where others have all that this
// process may claim, waits for one, and says on stderr who has them, how many runs are ahead, again
// whenever fewer are, and each half minute; or, if it is not to wait, returns the first of these
// sentences instead. Runs that wait get the CPUs in the order in which they came, but a run that is
// stopped meanwhile holds up nobody. Claims are locks on the CPU's folder in /sys, the queue is
// locks on the folder above (cpu_register.h): nothing is left behind. Where these cannot be opened,
// the CPU is taken unclaimed.
[[nodiscard]] std::variant<CpuClaim, std::string> ClaimCpu(bool waits);

// A claim that was given up for a while, as of a run that is paused: others may have the CPU until
// it is taken back. The claim outlives this.
class LentCpu {
 public:
  explicit LentCpu(const CpuClaim& claim);
  // Whether this process has the CPU again; it waits for it from the first time on that somebody
  // else has it, in the order in which runs came. To be asked again and again.
  [[nodiscard]] bool TakeBack();
  // Who has it, in words.
  std::string WhoHasIt() const;

 private:
  const CpuClaim& claim_;
  std::unique_ptr<CpuRegister> others_;  // once it waits
};

// Whether a tcsim has claimed it, also this one. False where that cannot be seen. Cheap, and does
// not sleep: /proc/locks, which says more, is read by stopping everybody's locks.
bool IsClaimed(int cpu);

// The CPU that ClaimCpu tries first, if nobody shares it.
int LastAllowedCpu();

}  // namespace tcs
