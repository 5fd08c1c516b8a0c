#include "coordinator/queues/wait_queues.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

constexpr KernelObject kSemaphore{.kind = 1, .id = 7}, kOtherSemaphore{.kind = 1, .id = 8},
    kQueue{.kind = 2, .id = 7};

using Threads = std::vector<WaitQueues::Thread>;

TEST(WaitQueues, NobodyWaitsAtFirst) {
  const WaitQueues queues;
  EXPECT_TRUE(queues.WaitersFor(kSemaphore).empty());
  EXPECT_TRUE(queues.AwaitedObjects().empty());
}

TEST(WaitQueues, ThreadsWaitInTheOrderInWhichTheyCame) {
  WaitQueues queues;
  queues.Wait(5, kSemaphore, false);
  queues.Wait(3, kSemaphore, false);
  queues.Wait(4, kOtherSemaphore, false);
  queues.Wait(1, kQueue, false);
  EXPECT_EQ(queues.WaitersFor(kSemaphore), (Threads{5, 3}));
  EXPECT_EQ(queues.WaitersFor(kQueue), (Threads{1}));
}

TEST(WaitQueues, WhoeverComesBackHasItsPlaceAgain) {
  WaitQueues queues;
  queues.Wait(5, kSemaphore, false);
  queues.Wait(3, kSemaphore, false);
  queues.Leave(5);
  EXPECT_EQ(queues.WaitersFor(kSemaphore), (Threads{3}));
  queues.Wait(5, kSemaphore, true);
  EXPECT_EQ(queues.WaitersFor(kSemaphore), (Threads{5, 3}));
}

TEST(WaitQueues, ANewWaitGoesBehindTheOthers) {
  WaitQueues queues;
  queues.Wait(5, kSemaphore, false);
  queues.Wait(3, kSemaphore, false);
  queues.Leave(5);
  queues.Wait(5, kSemaphore, false);
  EXPECT_EQ(queues.WaitersFor(kSemaphore), (Threads{3, 5}));
}

TEST(WaitQueues, APlaceIsInTheQueueOfOneObjectOnly) {
  WaitQueues queues;
  queues.Wait(5, kSemaphore, false);
  queues.Leave(5);
  queues.Wait(3, kOtherSemaphore, false);
  queues.Wait(5, kOtherSemaphore, true);
  EXPECT_EQ(queues.WaitersFor(kOtherSemaphore), (Threads{3, 5}));
}

TEST(WaitQueues, WhoeverGetsTheNumberOfOneThatHasEndedHasNoPlace) {
  WaitQueues queues;
  queues.Wait(5, kSemaphore, false);
  queues.Wait(3, kSemaphore, false);
  queues.Leave(5);
  queues.Forget(5);
  queues.Wait(5, kSemaphore, true);
  EXPECT_EQ(queues.WaitersFor(kSemaphore), (Threads{3, 5}));
}

TEST(WaitQueues, LeavingWithoutWaitingIsNothing) {
  WaitQueues queues;
  queues.Leave(5);
  queues.Wait(5, kSemaphore, false);
  queues.Leave(5);
  queues.Leave(5);
  EXPECT_TRUE(queues.WaitersFor(kSemaphore).empty());
}

TEST(WaitQueues, EachAwaitedObjectIsNamedOnceByTheLeastOfItsWaiters) {
  WaitQueues queues;
  queues.Wait(5, kSemaphore, false);
  queues.Wait(3, kQueue, false);
  queues.Wait(4, kSemaphore, false);
  queues.Wait(1, kOtherSemaphore, false);
  queues.Leave(1);
  EXPECT_EQ(queues.AwaitedObjects(), (std::vector<KernelObject>{kQueue, kSemaphore}));
}

TEST(WaitQueues, AThreadWaitsInOneQueueAtATime) {
  WaitQueues queues;
  queues.Wait(5, kSemaphore, false);
  EXPECT_DEATH(queues.Wait(5, kOtherSemaphore, false), "a bug in tcs");
}

}  // namespace
}  // namespace tcs
