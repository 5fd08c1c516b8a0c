#include "coordinator/policy/fixed_priority.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

constexpr int kPlanner = 1, kController = 2, kLogger = 3;

TEST(FixedPriority, NobodyRunsWhereNobodyIsReady) {
  EXPECT_FALSE(FixedPriority().First().has_value());
}

TEST(FixedPriority, TheMostUrgentRunsWheneverItBecameReady) {
  FixedPriority cpu;
  cpu.Add(kPlanner, 10);
  cpu.Add(kController, 80);
  EXPECT_EQ(cpu.First(), kController);
  cpu.Remove(kController);
  EXPECT_EQ(cpu.First(), kPlanner);
}

TEST(FixedPriority, AmongEqualsTheFirstReadyKeepsRunning) {
  FixedPriority cpu;
  cpu.Add(kPlanner, 10);
  cpu.Add(kLogger, 10);
  EXPECT_EQ(cpu.First(), kPlanner);
  EXPECT_TRUE(cpu.HasEqual(kPlanner));
  cpu.Add(kPlanner, 10);
  EXPECT_EQ(cpu.First(), kPlanner) << "being ready twice must not cost its turn";
}

TEST(FixedPriority, EqualsTakeTurnsWhenRotated) {
  FixedPriority cpu;
  for (const int thread : {kPlanner, kLogger, kController}) cpu.Add(thread, 10);
  for (const int turn : {kPlanner, kLogger, kController, kPlanner, kLogger}) {
    EXPECT_EQ(cpu.First(), turn);
    cpu.Rotate(turn);
  }
}

TEST(FixedPriority, RotatingDoesNotPassLessUrgentOnes) {
  FixedPriority cpu;
  cpu.Add(kController, 80);
  cpu.Add(kPlanner, 10);
  cpu.Rotate(kController);
  EXPECT_EQ(cpu.First(), kController);
  EXPECT_FALSE(cpu.HasEqual(kController));
}

TEST(FixedPriority, AThreadWhosePriorityChangesMovesBehindItsNewEquals) {
  FixedPriority cpu;
  cpu.Add(kController, 80);
  cpu.Add(kPlanner, 10);
  cpu.SetPriority(kPlanner, 80);
  EXPECT_EQ(cpu.First(), kController);
  cpu.SetPriority(kController, 5);
  EXPECT_EQ(cpu.First(), kPlanner);
  cpu.SetPriority(kLogger, 99);
  EXPECT_FALSE(cpu.IsReady(kLogger)) << "a priority makes nobody ready";
}

TEST(FixedPriority, RemovingOneThatIsNotReadyChangesNothing) {
  FixedPriority cpu;
  cpu.Add(kPlanner, 10);
  cpu.Remove(kLogger);
  EXPECT_EQ(cpu.size(), 1u);
}

}  // namespace
}  // namespace tcs
