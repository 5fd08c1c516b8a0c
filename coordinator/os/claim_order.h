// Which CPU a run may claim, among those that others hold, share and wait for. Pure.
//
// First come, first served: a run claims no CPU for which a run waits that has come before it. Runs
// that may use different CPUs do not wait for each other.
//
// Where a run may use more than two CPUs it never claims the first of them, so that one stays free
// of real-time threads. Of two it claims the first as a last choice, and only where the kernel
// leaves ordinary threads a part of it: shells and the kernel's own threads live there.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace tcs {

struct WaitingRun {
  std::int64_t ticket = 0;  // less than the tickets of runs that came later
  pid_t pid = 0;            // 0: this process cannot see it
  std::vector<int> cpus;    // the run waits for one of these
};

bool IsAwaited(int cpu, const std::vector<WaitingRun>& runs);

// The runs that may take a CPU away from a run that may use these CPUs.
std::vector<WaitingRun> RivalsOf(const std::vector<int>& cpus, std::vector<WaitingRun> runs);

// The CPUs of `allowed` (highest first) that a run may claim, in the order in which it tries them:
// the highest that no run shares, then the CPUs that runs share; these runs move.
std::vector<int> CpusToClaim(const std::vector<int>& allowed,
                             const std::function<bool(int)>& is_shared, bool leaves_others_some);

// The CPU of `allowed` (highest first) on which a run without real-time priorities goes: a CPU that
// nobody has claimed, and of those the one with the fewest other runs.
int CpuToShare(const std::vector<int>& allowed, const std::function<bool(int)>& is_claimed,
               const std::function<std::size_t(int)>& sharers);

// The words of a run for its place among the runs that wait.
std::string PlaceInWords(std::size_t ahead);

}  // namespace tcs
