#include "coordinator/policy/run_queue.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

constexpr int kPlanner = 1, kController = 2, kLogger = 3;
constexpr std::int64_t kNeverNs = INT64_MAX;

RunQueue::Thread FirstOfOneCore(RunQueue& robot) {
  robot.Assign({RobotTime(0)});
  return robot.Next(0).thread;
}

TEST(RunQueue, NobodyRunsWhereNobodyIsReady) {
  RunQueue robot(1);
  EXPECT_EQ(FirstOfOneCore(robot), RunQueue::kNobody);
  EXPECT_EQ(robot.Next(0).start.ns(), kNeverNs);
}

TEST(RunQueue, TheMostUrgentRunsWheneverItBecameReady) {
  RunQueue robot(1);
  robot.Add({kPlanner, 10, RobotTime(0)});
  robot.Add({kController, 80, RobotTime(0)});
  EXPECT_EQ(FirstOfOneCore(robot), kController);
  robot.Remove(kController);
  EXPECT_EQ(FirstOfOneCore(robot), kPlanner);
}

TEST(RunQueue, AmongEqualsTheFirstReadyKeepsRunning) {
  RunQueue robot(1);
  robot.Add({kPlanner, 10, RobotTime(0)});
  robot.Add({kLogger, 10, RobotTime(0)});
  EXPECT_EQ(FirstOfOneCore(robot), kPlanner);
  EXPECT_TRUE(robot.HasWaitingEqual(0));
  robot.Add({kPlanner, 10, RobotTime(0)});
  EXPECT_EQ(FirstOfOneCore(robot), kPlanner) << "being ready twice must not cost its turn";
}

TEST(RunQueue, EqualsTakeTurnsWhenRotated) {
  RunQueue robot(1);
  for (const int thread : {kPlanner, kLogger, kController}) robot.Add({thread, 10, RobotTime(0)});
  for (const int turn : {kPlanner, kLogger, kController, kPlanner, kLogger}) {
    EXPECT_EQ(FirstOfOneCore(robot), turn);
    robot.Rotate(turn);
  }
}

TEST(RunQueue, RotatingDoesNotPassLessUrgentOnes) {
  RunQueue robot(1);
  robot.Add({kController, 80, RobotTime(0)});
  robot.Add({kPlanner, 10, RobotTime(0)});
  robot.Rotate(kController);
  EXPECT_EQ(FirstOfOneCore(robot), kController);
  EXPECT_FALSE(robot.HasWaitingEqual(0));
}

TEST(RunQueue, WhoGoesFirstPrecedesItsEqualsUntilItIsRotated) {
  RunQueue robot(1);
  robot.Add({kPlanner, 10, RobotTime(0)});
  robot.Add({kLogger, 10, RobotTime(0), RunQueue::kEveryCore, true});
  EXPECT_EQ(FirstOfOneCore(robot), kLogger);
  EXPECT_FALSE(robot.YieldsTo(0, 10)) << "one that goes first, too, waits for its turn";
  robot.Rotate(kLogger);
  EXPECT_EQ(FirstOfOneCore(robot), kPlanner);
  EXPECT_TRUE(robot.YieldsTo(0, 10));
  EXPECT_FALSE(robot.YieldsTo(0, 10, false)) << "one that does not go first waits behind it";
  EXPECT_TRUE(robot.YieldsTo(0, 11, false));
}

TEST(RunQueue, ThoseWhoGoFirstDoSoInTheOrderOfTheirWaking) {
  RunQueue robot(1);
  robot.Add({kPlanner, 10, RobotTime(0)});
  robot.Add({kLogger, 10, RobotTime(0), RunQueue::kEveryCore, true});
  robot.Add({kController, 10, RobotTime(0), RunQueue::kEveryCore, true});
  for (const int turn : {kLogger, kController, kPlanner}) {
    EXPECT_EQ(FirstOfOneCore(robot), turn);
    robot.Remove(turn);
  }
}

TEST(RunQueue, WhoGoesFirstPrecedesNobodyMoreUrgent) {
  RunQueue robot(1);
  robot.Add({kController, 80, RobotTime(0)});
  robot.Add({kLogger, 10, RobotTime(0), RunQueue::kEveryCore, true});
  EXPECT_EQ(FirstOfOneCore(robot), kController);
  EXPECT_FALSE(robot.YieldsTo(0, 10));
  EXPECT_EQ(robot.NextToPrecede(0).ns(), kNeverNs);
}

TEST(RunQueue, ACoreHearsFromWhenOnAnEqualGoesBeforeItsThread) {
  RunQueue robot(1);
  robot.Add({kPlanner, 10, RobotTime(0)});
  robot.Add({kLogger, 10, RobotTime(700), RunQueue::kEveryCore, true});
  robot.Assign({RobotTime(300)});
  EXPECT_EQ(robot.Next(0).thread, kPlanner);
  EXPECT_EQ(robot.NextToPrecede(0).ns(), 700);
  robot.Assign({RobotTime(700)});
  EXPECT_EQ(robot.Next(0).thread, kLogger);
}

TEST(RunQueue, AThreadWhosePriorityChangesMovesBehindItsNewEquals) {
  RunQueue robot(1);
  robot.Add({kController, 80, RobotTime(0)});
  robot.Add({kPlanner, 10, RobotTime(0)});
  robot.SetPriority(kPlanner, 80);
  EXPECT_EQ(FirstOfOneCore(robot), kController);
  robot.SetPriority(kController, 5);
  EXPECT_EQ(FirstOfOneCore(robot), kPlanner);
  robot.SetPriority(kLogger, 99);
  EXPECT_FALSE(robot.IsReady(kLogger)) << "a priority makes nobody ready";
}

TEST(RunQueue, RemovingOneThatIsNotReadyChangesNothing) {
  RunQueue robot(1);
  robot.Add({kPlanner, 10, RobotTime(0)});
  robot.Remove(kLogger);
  EXPECT_EQ(robot.size(), 1u);
}

TEST(RunQueue, AThreadRunsNoEarlierThanItHasCome) {
  RunQueue robot(1);
  robot.Add({kController, 80, RobotTime(600)});
  robot.Add({kPlanner, 10, RobotTime(500)});
  robot.Assign({RobotTime(500)});
  EXPECT_EQ(robot.Next(0).thread, kPlanner) << "the controller wakes only at 600";
  EXPECT_EQ(robot.Next(0).start.ns(), 500);
  EXPECT_EQ(robot.NextToPrecede(0).ns(), 600);
  robot.Remove(kPlanner);
  robot.Assign({RobotTime(500)});
  EXPECT_EQ(robot.Next(0).thread, kController);
  EXPECT_EQ(robot.Next(0).start.ns(), 600);
  EXPECT_EQ(robot.NextToPrecede(0).ns(), kNeverNs);
}

TEST(RunQueue, EachCoreRunsAThreadOfItsOwn) {
  RunQueue robot(2);
  for (const int thread : {kPlanner, kController, kLogger}) robot.Add({thread, 10, RobotTime(0)});
  robot.Assign({RobotTime(0), RobotTime(0)});
  EXPECT_EQ(robot.Next(0).thread, kPlanner);
  EXPECT_EQ(robot.Next(1).thread, kController);
  EXPECT_TRUE(robot.HasWaitingEqual(0));
  robot.Remove(kPlanner);
  robot.Assign({RobotTime(0), RobotTime(0)});
  EXPECT_FALSE(robot.HasWaitingEqual(0));
}

TEST(RunQueue, AThreadStaysOnItsCoreThoughAnotherOneIsLessAdvanced) {
  RunQueue robot(2);
  robot.Add({kPlanner, 10, RobotTime(500)});
  robot.Ran(1, kPlanner);
  robot.Assign({RobotTime(300), RobotTime(500)});
  EXPECT_EQ(robot.Next(1).thread, kPlanner);
  EXPECT_EQ(robot.Next(0).thread, RunQueue::kNobody);
}

TEST(RunQueue, WhoWakesTakesTheIdleCore) {
  RunQueue robot(2);
  robot.Add({kPlanner, 10, RobotTime(500)});
  robot.Ran(0, kPlanner);
  robot.Add({kController, 80, RobotTime(500)});
  robot.Assign({RobotTime(500), RobotTime(300)});
  EXPECT_EQ(robot.Next(0).thread, kPlanner);
  EXPECT_EQ(robot.Next(1).thread, kController);
  EXPECT_EQ(robot.Next(1).start.ns(), 500);
}

TEST(RunQueue, WhoIsDisplacedMovesToAFreeCore) {
  RunQueue robot(2);
  robot.Add({kPlanner, 10, RobotTime(500)});
  robot.Ran(0, kPlanner);
  robot.Add({kController, 80, RobotTime(500), 1});  // only core 0
  robot.Assign({RobotTime(500), RobotTime(500)});
  EXPECT_EQ(robot.Next(0).thread, kController);
  EXPECT_EQ(robot.Next(1).thread, kPlanner);
}

TEST(RunQueue, TheLeastUrgentMakesRoomWhereAllCoresAreBusy) {
  RunQueue robot(2);
  robot.Add({kPlanner, 10, RobotTime(500)});
  robot.Add({kLogger, 5, RobotTime(500)});
  robot.Ran(0, kPlanner);
  robot.Ran(1, kLogger);
  robot.Add({kController, 80, RobotTime(500)});
  robot.Assign({RobotTime(500), RobotTime(500)});
  EXPECT_EQ(robot.Next(0).thread, kController);
  EXPECT_EQ(robot.Next(1).thread, kPlanner) << "and not the logger";
}

// The controller may run on core 1 alone, where the planner has run; so that one goes to core 0,
// before the logger.
TEST(RunQueue, WhoLosesItsCoreGoesBeforeTheLessUrgentElsewhere) {
  RunQueue robot(2);
  robot.Add({kPlanner, 30, RobotTime(0)});
  robot.Add({kLogger, 20, RobotTime(0)});
  robot.Ran(1, kPlanner);
  robot.Ran(0, kLogger);
  robot.Add({kController, 80, RobotTime(0), 1u << 1});
  robot.Assign({RobotTime(0), RobotTime(0)});
  EXPECT_EQ(robot.Next(0).thread, kPlanner);
  EXPECT_EQ(robot.Next(1).thread, kController);
  EXPECT_EQ(robot.NextToPrecede(0), VirtualTime::Never());
}

TEST(RunQueue, NobodyLosesItsCoreToWhoIsReadyLater) {
  RunQueue robot(2);
  robot.Add({kPlanner, 30, RobotTime(5)});
  robot.Add({kLogger, 20, RobotTime(0)});
  robot.Ran(1, kPlanner);
  robot.Add({kController, 80, RobotTime(0), 1u << 1});
  robot.Assign({RobotTime(0), RobotTime(0)});
  EXPECT_EQ(robot.Next(0).thread, kLogger);
  EXPECT_EQ(robot.NextToPrecede(0), RobotTime(5));
}

TEST(RunQueue, AffinityIsKept) {
  RunQueue robot(2);
  robot.Add({kPlanner, 10, RobotTime(0), 2});
  robot.Add({kLogger, 10, RobotTime(0), 2});
  robot.Assign({RobotTime(0), RobotTime(0)});
  EXPECT_EQ(robot.Next(0).thread, RunQueue::kNobody);
  EXPECT_EQ(robot.Next(1).thread, kPlanner);
  EXPECT_TRUE(robot.HasWaitingEqual(1));
}

}  // namespace
}  // namespace tcs
