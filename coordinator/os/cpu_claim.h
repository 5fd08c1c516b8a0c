// Which host CPU a run takes. Two coordinators on one CPU would stop each other's threads, so each
// claims its CPU for as long as it lives.
#pragma once

#include <string>
#include <utility>
#include <variant>

#include "coordinator/os/unique_fd.h"

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

// The last CPU that the calling process may use and no other tcsim has claimed; the first one only
// if there is no other, so that the rest of the machine keeps a CPU. Where all are claimed, waits
// for one, and says on stderr who has them; or, if it is not to wait, returns that sentence
// instead. Claims are locks on the CPU's folder in /sys: nothing is left behind. Where that cannot
// be opened, the CPU is taken unclaimed.
[[nodiscard]] std::variant<CpuClaim, std::string> ClaimCpu(bool waits);

// Whether a tcsim has claimed it, also this one. False where that cannot be seen. Cheap, and does
// not sleep: /proc/locks, which says more, is read by stopping everybody's locks.
bool IsClaimed(int cpu);

// The CPU that ClaimCpu tries first.
int LastAllowedCpu();

}  // namespace tcs
