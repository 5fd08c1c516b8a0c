#include "coordinator/os/real_time_right.h"

#include <errno.h>
#include <gtest/gtest.h>

namespace tcs {
namespace {

using Obstacles = std::vector<RealTimeObstacle>;

bool Has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

RealTimeGroup WithoutBudget() { return {.folder = "/sys/fs/cgroup/cpu/a/b"}; }

TEST(RealTimeRight, NothingIsInTheWayOfWhoIsPermitted) {
  EXPECT_EQ(ObstaclesOf({}), Obstacles{});
  EXPECT_EQ(WhyNoRealTime({}), "");
  EXPECT_EQ(MendOfRealTime({}), "");
  // As where the kernel heeds no budgets (kernel.sched_rt_runtime_us is -1).
  EXPECT_EQ(ObstaclesOf({.has_capability = true, .group = WithoutBudget()}), Obstacles{});
}

TEST(RealTimeRight, AnOrdinaryUserLacksBothCapabilityAndLimit) {
  const RealTimeFacts user{.error = EPERM, .may_get_capability = true};
  EXPECT_EQ(ObstaclesOf(user), Obstacles{RealTimeObstacle::kNoRight});
  EXPECT_EQ(WhyNoRealTime(user), "CAP_SYS_NICE is missing and RLIMIT_RTPRIO is 0");
  EXPECT_TRUE(Has(MendOfRealTime(user), "run tcsim as root, or call `sudo prlimit --rtprio=14"));
  EXPECT_FALSE(GivesRealTime(user));
}

TEST(RealTimeRight, RootIsNotToldToRunAsRoot) {
  const RealTimeFacts root{.error = EPERM, .is_root = true};
  EXPECT_EQ(ObstaclesOf(root), Obstacles{RealTimeObstacle::kNoRight});
  EXPECT_FALSE(Has(MendOfRealTime(root), "as root"));
  EXPECT_TRUE(Has(MendOfRealTime(root), "--cap-add SYS_NICE"));
  // Nor is a user of a container, where root has no more.
  EXPECT_FALSE(Has(MendOfRealTime({.error = EPERM}), "as root"));
}

TEST(RealTimeRight, ALimitThatIsTooLowIsNamed) {
  const RealTimeFacts low{.error = EPERM, .limit = 5, .can_raise_limit = true};
  EXPECT_EQ(ObstaclesOf(low), Obstacles{RealTimeObstacle::kLowLimit});
  EXPECT_TRUE(Has(WhyNoRealTime(low), "RLIMIT_RTPRIO is 5, below 14"));
  EXPECT_EQ(MendOfRealTime(low), "call `ulimit -r 14` in the shell that starts tcsim");
  EXPECT_TRUE(GivesRealTime(low));
}

TEST(RealTimeRight, ACapabilityDoesNotCountInAUserNamespace) {
  const RealTimeFacts inside{.error = EPERM, .has_capability = true, .in_user_namespace = true};
  EXPECT_EQ(ObstaclesOf(inside), Obstacles{RealTimeObstacle::kNoRight});
  EXPECT_TRUE(Has(WhyNoRealTime(inside), "does not count in a user namespace"));
  EXPECT_TRUE(Has(MendOfRealTime(inside), "outside of the user namespace"));
  EXPECT_FALSE(GivesRealTime(inside));
}

TEST(RealTimeRight, AGroupWithoutABudgetIsNamedWithTheNearestThatHasOne) {
  RealTimeFacts root{
      .error = EPERM, .has_capability = true, .is_root = true, .group = WithoutBudget()};
  EXPECT_EQ(ObstaclesOf(root), Obstacles{RealTimeObstacle::kGroup});
  EXPECT_TRUE(Has(WhyNoRealTime(root), "/sys/fs/cgroup/cpu/a/b/cpu.rt_runtime_us is 0"));
  EXPECT_TRUE(Has(MendOfRealTime(root), "sysctl -w kernel.sched_rt_runtime_us=-1"));
  EXPECT_TRUE(GivesRealTime(root)) << "the group is the host's, not the user's";
  root.group->with_budget = "/sys/fs/cgroup/cpu";
  EXPECT_TRUE(Has(MendOfRealTime(root), "echo $$ >/sys/fs/cgroup/cpu/tasks"));
}

TEST(RealTimeRight, AFilterIsToldFromTheKernel) {
  RealTimeFacts root{
      .error = EPERM, .reaches_kernel = false, .is_filtered = true, .has_capability = true};
  EXPECT_EQ(ObstaclesOf(root), Obstacles{RealTimeObstacle::kFilter});
  EXPECT_EQ(WhyNoRealTime(root), "a seccomp filter refuses it");
  EXPECT_TRUE(Has(MendOfRealTime(root), "RestrictRealtime=no"));
  EXPECT_TRUE(GivesRealTime(root));
  // Docker filters everything; that is not why.
  root.reaches_kernel = true;
  root.has_capability = false;
  EXPECT_EQ(ObstaclesOf(root), Obstacles{RealTimeObstacle::kNoRight});
}

TEST(RealTimeRight, AllThatIsInTheWayIsNamed) {
  const RealTimeFacts user{.error = EPERM, .may_get_capability = true, .group = WithoutBudget()};
  EXPECT_EQ(ObstaclesOf(user), (Obstacles{RealTimeObstacle::kNoRight, RealTimeObstacle::kGroup}));
  EXPECT_TRUE(Has(WhyNoRealTime(user), "RLIMIT_RTPRIO is 0; its real-time group"));
  EXPECT_TRUE(Has(MendOfRealTime(user), "limits.conf); then let root call `sysctl"));
}

TEST(RealTimeRight, WhatIsNotKnownIsToldByTheKernelsWord) {
  const RealTimeFacts root{.error = EPERM, .has_capability = true, .is_root = true};
  EXPECT_EQ(ObstaclesOf(root), Obstacles{RealTimeObstacle::kUnknown});
  EXPECT_TRUE(Has(WhyNoRealTime(root), "'Operation not permitted'"));
  EXPECT_TRUE(Has(MendOfRealTime(root), "sysctl -w kernel.sched_rt_runtime_us=-1"));
}

}  // namespace
}  // namespace tcs
