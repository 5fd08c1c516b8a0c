#include "coordinator/computer/computer_file.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

using Kind = ComputerFile::Kind;

ComputerFile At(const char* path) {
  return ComputerFileAt(path, 100, 101).value_or(ComputerFile{.kind = Kind{}, .rest = "none"});
}

TEST(ComputerFile, PlainNamesHaveNoDetours) {
  EXPECT_EQ(PlainName("//proc/./self/../uptime"), "/proc/uptime");
  EXPECT_EQ(PlainName("/sys/devices/system/cpu/"), "/sys/devices/system/cpu");
  EXPECT_EQ(PlainName("/../.."), "/");
  EXPECT_EQ(PlainName(""), "/");
}

TEST(ComputerFile, ProcessesAreNamedInSeveralWays) {
  EXPECT_EQ(At("/proc/self/stat").process, 100);
  EXPECT_EQ(At("/proc/self/stat").thread, 0);
  EXPECT_EQ(At("/proc/thread-self/status").thread, 101);
  EXPECT_EQ(At("/proc/thread-self/status").kind, Kind::kProcessStatus);
  EXPECT_EQ(At("/proc/7/schedstat").process, 7);
  EXPECT_EQ(At("/proc/7/schedstat").kind, Kind::kProcessSchedule);
  EXPECT_EQ(At("/proc/7/task/8/stat").process, 7);
  EXPECT_EQ(At("/proc/7/task/8/stat").thread, 8);
}

TEST(ComputerFile, FoldersKeepTheNamesInThem) {
  EXPECT_EQ(At("/sys/devices/system/cpu").kind, Kind::kProcessorFolder);
  EXPECT_EQ(At("/sys/devices/system/cpu").rest, "");
  EXPECT_EQ(At("/sys/devices/system/cpu/cpu1/online").rest, "cpu1/online");
  EXPECT_EQ(At("/sys/devices/system/node/node0").kind, Kind::kNodeFolder);
}

TEST(ComputerFile, LimitsOfControlGroupsAreKnownAnywhereAmongThem) {
  EXPECT_EQ(At("/sys/fs/cgroup/cpu.max").kind, Kind::kQuota);
  EXPECT_EQ(At("/sys/fs/cgroup/user.slice/a/cpu.max").kind, Kind::kQuota);
  EXPECT_EQ(At("/sys/fs/cgroup/cpu/cpu.cfs_quota_us").kind, Kind::kOldQuota);
  EXPECT_EQ(At("/sys/fs/cgroup/cpuset.cpus.effective").kind, Kind::kProcessorSet);
}

TEST(ComputerFile, AllElseIsTheKernels) {
  for (const char* path :
       {"/proc", "/proc/", "/proc/self", "/proc/self/maps", "/proc/self/fd/stat", "/proc/x/stat",
        "/proc/-1/stat", "/proc/0/stat", "/proc/7x/stat", "/proc/7/task/x/stat",
        "/proc/99999999999/stat", "/proc/self/task/8", "/proc/cpuinfox",
        "/sys/devices/system/cpufreq", "/sys/devices/system", "/sys/fs/cgroup/memory.max",
        "/sys/fs/cgroup", "/home/proc/stat", "/proc/self/task/8/9/stat"}) {
    EXPECT_EQ(At(path).rest, "none") << path;
  }
}

}  // namespace
}  // namespace tcs
