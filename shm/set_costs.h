// The costs of memory allocations under fixed accounting, unless a scenario says otherwise.
//
// An allocation stands for what a program computes until its next one. A thread that works on a
// message and waits again computes little between two allocations: nodes of ROS 2 make hundreds of
// allocations for each service call, one in 0.25 us. A thread that makes thousands without waiting
// computes: planners, compilers and interpreters make one in some 2 us (docs/decisions/0006). So
// the first allocations since a thread's last wait cost less than those that follow.
#pragma once

#include <cstdint>

namespace tcs::shm {

// In ClockPage::allocation_cost_ns: the costs below, rather than one cost for each allocation.
inline constexpr std::int64_t kUsualAllocationCost = -1;

inline constexpr std::uint32_t kShortAllocations = 4'000;
inline constexpr std::int64_t kShortAllocationNs = 250, kLongAllocationNs = 2'000;

// The cost of the allocation with that number, from 1 on, since its thread last waited.
constexpr std::int64_t AllocationCostNs(std::int64_t set_ns, std::uint32_t number) {
  if (set_ns != kUsualAllocationCost) return set_ns;
  return number <= kShortAllocations ? kShortAllocationNs : kLongAllocationNs;
}

// The cost of a pause: as long as recent processors take for one, some 140 cycles.
inline constexpr std::int64_t kPauseNs = 40;

// The cost of a lock, where locks are charged: a hundredth of what an allocation costs in a thread
// that computes, but at least something. A thread that waits in a loop of locks must get on.
constexpr std::int64_t LockCostNs(std::int64_t set_ns, std::int64_t locks_per_allocation) {
  const std::int64_t allocation_ns = set_ns == kUsualAllocationCost ? kLongAllocationNs : set_ns;
  return allocation_ns > locks_per_allocation ? allocation_ns / locks_per_allocation : 1;
}

}  // namespace tcs::shm
