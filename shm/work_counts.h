// Counts of what a thread does that has a set cost under fixed accounting: `tcsim fit` makes these
// costs from them. Written by the thread; figures only, so the coordinator believes any value.
#pragma once

#include <cstdint>

namespace tcs::shm {

struct WorkCounts {
  // Taking and releasing a lock is 20 ns of processor time natively, a hundredth of what an
  // allocation stands for unless told.
  static constexpr std::uint64_t kLocksPerAllocation = 100;

  std::uint64_t calls;  // that the shim, or the trap, has intercepted
  std::uint64_t locks;  // an allocation counts as kLocksPerAllocation

  // Whole allocations.
  std::uint64_t allocations() const { return locks / kLocksPerAllocation; }
};
static_assert(sizeof(WorkCounts) == 16);

}  // namespace tcs::shm
