// What memory allocations cost under fixed accounting unless a scenario says otherwise.
//
// An allocation stands for what a program computes until its next one. That is little where a
// thread works on a message and waits again: nodes of ROS 2 make hundreds of allocations for each
// service call, one in 0.25 us. A thread that makes thousands without waiting computes: planners,
// compilers and interpreters make one in some 2 us (docs/decisions/0006). So the first ones since
// its last wait cost less than those that follow.
#pragma once

#include <cstdint>

namespace tcs::shm {

// In ClockPage::allocation_cost_ns: what follows, rather than the same for each.
inline constexpr std::int64_t kUsualAllocationCost = -1;

inline constexpr std::uint32_t kShortAllocations = 4'000;
inline constexpr std::int64_t kShortAllocationNs = 250, kLongAllocationNs = 2'000;

// Of the allocation with that number, from 1 on, since its thread last waited.
constexpr std::int64_t AllocationCostNs(std::int64_t set_ns, std::uint32_t number) {
  if (set_ns != kUsualAllocationCost) return set_ns;
  return number <= kShortAllocations ? kShortAllocationNs : kLongAllocationNs;
}

// Of a pause: what processors of late take for one, some 140 cycles.
inline constexpr std::int64_t kPauseNs = 40;

// Of a lock, where one is charged: a hundredth of what an allocation costs in a thread that
// computes, but at least something. Whoever waits in a loop of locks must get on.
constexpr std::int64_t LockCostNs(std::int64_t set_ns, std::int64_t locks_per_allocation) {
  const std::int64_t allocation_ns = set_ns == kUsualAllocationCost ? kLongAllocationNs : set_ns;
  return allocation_ns > locks_per_allocation ? allocation_ns / locks_per_allocation : 1;
}

}  // namespace tcs::shm
