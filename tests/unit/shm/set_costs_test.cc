#include "shm/set_costs.h"

#include <gtest/gtest.h>

#include "shm/work_counts.h"

namespace tcs::shm {
namespace {

TEST(SetCosts, AnAllocationCostsWhatItIsSaidTo) {
  for (const std::uint32_t number : {1u, kShortAllocations, kShortAllocations + 1}) {
    EXPECT_EQ(AllocationCostNs(150, number), 150);
    EXPECT_EQ(AllocationCostNs(0, number), 0);
  }
}

TEST(SetCosts, UsuallyTheFirstSinceAWaitCostLess) {
  EXPECT_EQ(AllocationCostNs(kUsualAllocationCost, 1), 250);
  EXPECT_EQ(AllocationCostNs(kUsualAllocationCost, 4'000), 250);
  EXPECT_EQ(AllocationCostNs(kUsualAllocationCost, 4'001), 2'000);
}

TEST(SetCosts, ALockCostsAHundredthOfAnAllocationButAtLeastSomething) {
  constexpr auto kLocks = static_cast<std::int64_t>(WorkCounts::kLocksPerAllocation);
  EXPECT_EQ(LockCostNs(kUsualAllocationCost, kLocks), 20);
  EXPECT_EQ(LockCostNs(5'000, kLocks), 50);
  EXPECT_EQ(LockCostNs(150, kLocks), 1);
  EXPECT_EQ(LockCostNs(3, kLocks), 1);
}

}  // namespace
}  // namespace tcs::shm
