#include "coordinator/os/tsc_facts.h"

#include <gtest/gtest.h>

#include <string>

namespace tcs {
namespace {

std::string CpuinfoWith(const std::string& flags) {
  return "processor\t: 0\nvendor_id\t: GenuineIntel\nflags\t\t: " + flags + "\nbugs\t\t: a b\n\n";
}

TEST(TscFacts, AClockIsATscThatKeepsItsRateAndNeverStops) {
  EXPECT_EQ(KindOfTsc(CpuinfoWith("fpu constant_tsc rep_good nonstop_tsc")), TscKind::kClock);
  EXPECT_EQ(KindOfTsc(CpuinfoWith("nonstop_tsc constant_tsc sse")), TscKind::kClock);
  EXPECT_EQ(KindOfTsc(CpuinfoWith("fpu constant_tsc")), TscKind::kNoClock);
  EXPECT_EQ(KindOfTsc(CpuinfoWith("fpu nonstop_tsc hypervisor")), TscKind::kNoClock);
  EXPECT_EQ(KindOfTsc(CpuinfoWith("fpu xconstant_tsc nonstop_tsc_s3")), TscKind::kNoClock);
  EXPECT_EQ(KindOfTsc("nonstop_tsc constant_tsc"), TscKind::kNoClock);
}

TEST(TscFacts, AHypervisorNeedNotSayThatItNeverStops) {
  EXPECT_EQ(KindOfTsc(CpuinfoWith("constant_tsc hypervisor")), TscKind::kOfGuest);
  EXPECT_EQ(KindOfTsc(CpuinfoWith("constant_tsc hypervisor nonstop_tsc")), TscKind::kClock);
}

TEST(TscFacts, OnlyTheFirstProcessorNeedBeWhole) {
  const std::string first = CpuinfoWith("constant_tsc nonstop_tsc");
  EXPECT_EQ(KindOfTsc(first + "processor\t: 1\nfla"), TscKind::kClock);
}

}  // namespace
}  // namespace tcs
