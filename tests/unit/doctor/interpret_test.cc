#include "coordinator/doctor/interpret.h"

#include <errno.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <algorithm>

#include "coordinator/doctor/doctor.h"
#include "coordinator/doctor/wakeups.h"

namespace tcs {
namespace {

TEST(Doctor, WithoutRealTimePriorityGatesKeepThreadsApart) {
  const Finding permitted = JudgeRealTime({});
  EXPECT_EQ(permitted.verdict, Verdict::kOk);
  EXPECT_NE(permitted.found.find("gates would"), std::string::npos);
  const Finding refused = JudgeRealTime({.error = EPERM, .may_get_capability = true});
  EXPECT_EQ(refused.verdict, Verdict::kWarning);
  EXPECT_NE(refused.found.find("gates and a signal keep"), std::string::npos);
  EXPECT_NE(refused.mend.find("less time"), std::string::npos);
  EXPECT_NE(refused.found.find("CAP_SYS_NICE is missing"), std::string::npos);
  EXPECT_NE(refused.mend.find("limits.conf"), std::string::npos);
  EXPECT_TRUE(CanRun({permitted, refused}));
}

TEST(Doctor, ThrottlingIsAWarningUnlessItIsOff) {
  EXPECT_EQ(JudgeThrottling("-1\n", "1000000\n", "6.1.0-28\n").verdict, Verdict::kOk);
  EXPECT_EQ(JudgeThrottling("1000000\n", "1000000\n", "6.1.0-28\n").verdict, Verdict::kOk);
  const Finding on = JudgeThrottling("950000\n", "1000000\n", "6.1.0-28\n");
  EXPECT_EQ(on.verdict, Verdict::kWarning);
  EXPECT_NE(on.found.find("95 %"), std::string::npos);
  EXPECT_TRUE(CanRun({on}));
}

TEST(Doctor, TheFairServerDoesNotHeedTheThrottlesSetting) {
  for (const char* release : {"6.12.1\n", "6.18.0-rc1\n", "7.0\n"}) {
    const Finding server = JudgeThrottling("-1\n", "1000000\n", release);
    EXPECT_EQ(server.verdict, Verdict::kWarning) << release;
    EXPECT_NE(server.mend.find("fair_server"), std::string::npos);
    EXPECT_EQ(server.mend.find("sched_rt_runtime_us"), std::string::npos) << "it is off";
    // Kernels with real-time groups do heed it.
    const Finding both = JudgeThrottling("950000\n", "1000000\n", release);
    EXPECT_NE(both.mend.find("fair_server"), std::string::npos);
    EXPECT_NE(both.mend.find("sched_rt_runtime_us=-1"), std::string::npos);
  }
}

TEST(Doctor, WithoutATrapItSaysWhatThatMeans) {
  EXPECT_EQ(JudgeTrap(0).verdict, Verdict::kOk);
  const Finding taken = JudgeTrap(EBUSY);
  EXPECT_EQ(taken.verdict, Verdict::kWarning);
  EXPECT_NE(taken.found.find("another one"), std::string::npos);
}

TEST(Doctor, TheTscMustBeInvariant) {
  EXPECT_EQ(JudgeTsc("flags : fpu constant_tsc nonstop_tsc", "tsc\n").verdict, Verdict::kOk);
  EXPECT_EQ(JudgeTsc("flags : fpu constant_tsc", "tsc\n").verdict, Verdict::kMissing);
  EXPECT_EQ(JudgeTsc("flags : constant_tsc hypervisor", "tsc\n").verdict, Verdict::kWarning);
  EXPECT_EQ(JudgeTsc("flags : constant_tsc nonstop_tsc_s3", "tsc\n").verdict, Verdict::kMissing);
  EXPECT_EQ(JudgeTsc("flags : constant_tsc nonstop_tsc", "hpet\n").verdict, Verdict::kWarning);
}

TEST(Doctor, AnIsolatedProcessorIsFoundInTheKernelsList) {
  EXPECT_NE(JudgeCpu(3, 4, "1,2-3\n").found.find("isolated"), std::string::npos);
  EXPECT_EQ(JudgeCpu(3, 4, "1-2,13\n").found.find("isolated"), std::string::npos);
  EXPECT_EQ(JudgeCpu(0, 1, "\n").verdict, Verdict::kWarning);
}

TEST(Doctor, WherePidfdGetfdIsRefusedAProcessBesideEachProgramHandsDescriptorsOver) {
  const Finding permitted = JudgeDescriptors(0, 0);
  EXPECT_EQ(permitted.verdict, Verdict::kOk);
  EXPECT_NE(permitted.found.find("would hand descriptors over"), std::string::npos);
  const Finding refused = JudgeDescriptors(EPERM, 0);
  EXPECT_EQ(refused.verdict, Verdict::kWarning);
  EXPECT_NE(refused.found.find("SCHED_FIFO is not used"), std::string::npos);
  EXPECT_NE(refused.mend.find("SYS_PTRACE"), std::string::npos);
  EXPECT_TRUE(CanRun({permitted, refused}));
}

TEST(Doctor, WithoutALookIntoChildrenNothingRuns) {
  const Finding blind = JudgeDescriptors(0, EPERM);
  EXPECT_EQ(blind.verdict, Verdict::kMissing);
  EXPECT_NE(blind.mend.find("ptrace_scope"), std::string::npos);
}

TEST(Doctor, AnAddressLayoutThatCannotBeFixedIsAWarning) {
  EXPECT_EQ(JudgeLayout(0).verdict, Verdict::kOk);
  const Finding random = JudgeLayout(EPERM);
  EXPECT_EQ(random.verdict, Verdict::kWarning);
  EXPECT_NE(random.found.find("personality is refused"), std::string::npos);
  EXPECT_TRUE(CanRun({random}));
}

TEST(Doctor, WhatRobotsWithNetworksLackIsNamedWithItsMend) {
  EXPECT_EQ(JudgeNetworks(std::nullopt, false).verdict, Verdict::kOk);
  EXPECT_NE(JudgeNetworks(std::nullopt, true).found.find("user namespaces"), std::string::npos);
  struct Case {
    NoComputer why_not;
    const char *found, *mend;
  };
  const Case cases[] = {
      {{"/dev/net/tun", ENOENT}, "(/dev/net/tun: No such file", "modprobe tun"},
      {{"/dev/net/tun", EACCES}, "(/dev/net/tun: Permission denied)", "chmod 666 /dev/net/tun"},
      {{"/proc/sys/net", EROFS}, "Read-only", "mount /proc/sys for writing"},
      {{"user namespace", EPERM}, "(user namespace: ", "allow user namespaces"},
      {{"mount --make-rslave /", EINVAL}, "(mount --make-rslave /: Inv", "mount --rbind DIR DIR"},
      {{"a seccomp filter on unshare", EPERM}, "(a seccomp filter", "outside of the filter"},
      {{"user namespace, in a chroot", EPERM}, "in a chroot: ", "outside of the chroot"},
      {{"user.max_user_namespaces", ENOSPC}, "No space", "sysctl -w user.max_user_namespaces=1000"},
      {{"unshare", ENOSPC}, "(unshare: No space", "user.max_net_namespaces=1000"},
      {{"kernel.unprivileged_userns_clone", EPERM}, "(kernel.", "unprivileged_userns_clone=1"},
      {{"kernel.apparmor_restrict_unprivileged_userns", EACCES}, "(kernel.", "_userns=0"},
  };
  for (const Case& c : cases) {
    const Finding missing = JudgeNetworks(c.why_not, true);
    EXPECT_EQ(missing.verdict, Verdict::kWarning);
    EXPECT_NE(missing.found.find(c.found), std::string::npos) << missing.found;
    EXPECT_NE(missing.mend.find(c.mend), std::string::npos) << missing.mend;
    EXPECT_TRUE(CanRun({missing})) << "scenarios without `network` run";
  }
}

TEST(Doctor, AnOldCLibraryIsAWarning) {
  EXPECT_EQ(JudgeLibc("2.35", true).verdict, Verdict::kOk);
  EXPECT_EQ(JudgeLibc("3.0", true).verdict, Verdict::kOk);
  EXPECT_EQ(JudgeLibc("2.31", true).verdict, Verdict::kWarning);
}

TEST(Doctor, WhereJoinsCannotBeSeenToEndIsOfTheLibrarysAge) {
  EXPECT_EQ(JudgeLibc("2.42", false).verdict, Verdict::kOk);
  EXPECT_EQ(JudgeLibc("2.43", true).verdict, Verdict::kOk);
  const Finding blind = JudgeLibc("2.43", false);
  EXPECT_EQ(blind.verdict, Verdict::kMissing);
  EXPECT_NE(blind.mend.find("CONFIG_CHECKPOINT_RESTORE"), std::string::npos);
}

TEST(Doctor, AShimThatSaysSomethingDoesNotLoad) {
  EXPECT_EQ(JudgeShim("/x.so", 0, "").verdict, Verdict::kOk);
  // The dynamic loader only warns, and runs the program without the shim.
  EXPECT_EQ(JudgeShim("/x.so", 0, "ERROR: ld.so: object cannot be preloaded\n").verdict,
            Verdict::kMissing);
  EXPECT_EQ(JudgeShim("/x.so", 11, "").verdict, Verdict::kMissing);
}

TEST(Doctor, StolenTimeIsAShareOfTheBusyTime) {
  EXPECT_EQ(JudgeSteal("cpu  900 0 90 5000 0 0 0 10 0 0\n").verdict, Verdict::kOk);
  const Finding stolen = JudgeSteal("cpu  800 0 100 5000 0 0 0 100 0 0\n");
  EXPECT_EQ(stolen.verdict, Verdict::kWarning);
  EXPECT_NE(stolen.found.find("10.0 %"), std::string::npos);
}

TEST(Doctor, WakeupsAreSaidAsAScenarioHasThem) {
  EXPECT_EQ(JudgeWakeups(Wakeups{.median_ns = 57'600, .p99_ns = 130'200}, {}).found,
            "of ordinary threads as cpu: {wakeup: {median: 58us, p99: 130us}}");
  EXPECT_EQ(JudgeWakeups(Wakeups{.median_ns = 57'600, .p99_ns = 130'200},
                         Wakeups{.median_ns = 400, .p99_ns = 9'000})
                .found,
            "of ordinary threads as cpu: {wakeup: {median: 58us, p99: 130us}}, of real-time ones "
            "as cpu: {wakeup: {median: 1us, p99: 9us}}");
}

// A sleep never ends early, and each policy that there can be is tried.
TEST(Doctor, WakeupsAreMeasured) {
  const auto ordinary = MeasureWakeups(SCHED_OTHER);
  ASSERT_TRUE(ordinary.has_value());
  EXPECT_GT(ordinary->median_ns, 0);
  EXPECT_GE(ordinary->p99_ns, ordinary->median_ns);
  EXPECT_FALSE(MeasureWakeups(-1).has_value());
}

TEST(Doctor, AMissingShimIsFoundByTryingIt) {
  for (const Finding& finding : Examine("/nonexistent/libtcs_preload.so")) {
    if (finding.name != "shim") continue;
    EXPECT_EQ(finding.verdict, Verdict::kMissing);
    return;
  }
  FAIL() << "the shim was not tried";
}

TEST(Doctor, TextHasOneLineForWhatIsWellAndTwoForWhatIsNot) {
  EXPECT_EQ(ToText({{"a", Verdict::kOk, "fine", ""}}, false),
            "ok       a                       fine\n");
  const std::string text = ToText({{"b", Verdict::kMissing, "gone", "get it"}}, false);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2);
  EXPECT_EQ(text.find('\033'), std::string::npos);
}

}  // namespace
}  // namespace tcs
