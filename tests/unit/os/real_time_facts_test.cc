#include "coordinator/os/real_time_facts.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include "coordinator/port/levels.h"
#include "coordinator/port/proc_files.h"

namespace tcs {
namespace {

constexpr char kMounts[] =
    "31 23 0:28 / /sys/fs/cgroup rw - tmpfs none rw\n"
    "33 31 0:30 / /sys/fs/cgroup/cpuacct rw,relatime - cgroup cgroup rw,cpuacct\n"
    "32 31 0:29 / /sys/fs/cgroup/cpu rw,relatime shared:9 - cgroup cgroup rw,cpu\n"
    "41 31 0:38 / /sys/fs/cgroup/unified rw,relatime - cgroup2 cgroup2 rw\n";

std::string FolderOf(const std::string& groups, const std::string& mounts) {
  const auto place = PlaceOfCpuGroup(groups, mounts);
  return place ? place->folder : "none";
}

TEST(RealTimeFacts, TheGroupOfTheCpuControllerIsFoundWhereItIsMounted) {
  EXPECT_EQ(FolderOf("2:cpuacct:/x\n1:cpu:/\n0::/y\n", kMounts), "/sys/fs/cgroup/cpu");
  EXPECT_EQ(FolderOf("1:cpu:/a/b\n", kMounts), "/sys/fs/cgroup/cpu/a/b");
  EXPECT_EQ(PlaceOfCpuGroup("1:cpu:/a/b\n", kMounts)->top, "/sys/fs/cgroup/cpu");
  EXPECT_EQ(FolderOf("4:cpu,cpuacct:/a\n", "1 2 0:3 / /c rw - cgroup c rw,cpu,cpuacct\n"), "/c/a");
}

TEST(RealTimeFacts, AContainerSeesItsOwnGroupAsTheTop) {
  constexpr char kOwn[] = "1 2 0:3 /docker/1 /c ro master:5 - cgroup cgroup rw,cpu\n";
  EXPECT_EQ(FolderOf("1:cpu:/docker/1\n", kOwn), "/c");
  EXPECT_EQ(FolderOf("1:cpu:/\n", kOwn), "/c");
  EXPECT_EQ(FolderOf("1:cpu:/docker/1/sub\n", kOwn), "/c/sub");
  EXPECT_EQ(FolderOf("1:cpu:/docker/12\n", kOwn), "none");
}

TEST(RealTimeFacts, WithoutTheControllerThereIsNoGroup) {
  EXPECT_EQ(FolderOf("0::/user.slice\n", "1 2 0:3 / /sys/fs/cgroup rw - cgroup2 cgroup2 rw\n"),
            "none");
  EXPECT_EQ(FolderOf("", ""), "none");
}

TEST(RealTimeFacts, AskingLeavesNothingBehind) {
  const int policy = sched_getscheduler(0);
  rlimit before{}, after{};
  getrlimit(RLIMIT_RTPRIO, &before);
  const RealTimeFacts facts = AskForRealTime();
  getrlimit(RLIMIT_RTPRIO, &after);
  EXPECT_EQ(sched_getscheduler(0), policy);
  EXPECT_EQ(before.rlim_cur, after.rlim_cur);
  EXPECT_EQ(before.rlim_max, after.rlim_max);
  // The kernel's answer is that of the call itself.
  const bool is_permitted = SetLevel(0, Level::kKernelOnly);
  LeaveRealTime(0);
  EXPECT_EQ(facts.error == 0, is_permitted);
  EXPECT_EQ(ObstaclesOf(facts).empty(), is_permitted);
}

TEST(RealTimeFacts, LimitsAreReadOfAnyThread) {
  rlimit limit{};
  getrlimit(RLIMIT_RTPRIO, &limit);
  EXPECT_EQ(ReadSoftLimit(getpid(), "Max realtime priority"), limit.rlim_cur);
  getrlimit(RLIMIT_NOFILE, &limit);
  EXPECT_EQ(ReadSoftLimit(getpid(), "Max open files"), limit.rlim_cur);
  EXPECT_EQ(ReadSoftLimit(0x3ffffff, "Max open files"), 0u);
}

}  // namespace
}  // namespace tcs
