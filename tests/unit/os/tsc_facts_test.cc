#include "coordinator/os/tsc_facts.h"

#include <gtest/gtest.h>

#include <string>

namespace tcs {
namespace {

std::string CpuinfoWith(const std::string& flags) {
  return "processor\t: 0\nvendor_id\t: GenuineIntel\nflags\t\t: " + flags + "\nbugs\t\t: a b\n\n";
}

TEST(TscFacts, AClockIsATscThatKeepsItsRateAndNeverStops) {
  EXPECT_TRUE(IsTscInvariant(CpuinfoWith("fpu constant_tsc rep_good nonstop_tsc")));
  EXPECT_TRUE(IsTscInvariant(CpuinfoWith("nonstop_tsc constant_tsc sse")));
  EXPECT_FALSE(IsTscInvariant(CpuinfoWith("fpu constant_tsc")));
  EXPECT_FALSE(IsTscInvariant(CpuinfoWith("fpu nonstop_tsc")));
  EXPECT_FALSE(IsTscInvariant(CpuinfoWith("fpu xconstant_tsc nonstop_tsc_s3")));
  EXPECT_FALSE(IsTscInvariant("nonstop_tsc constant_tsc"));
}

TEST(TscFacts, OnlyTheFirstProcessorNeedBeWhole) {
  const std::string first = CpuinfoWith("constant_tsc nonstop_tsc");
  EXPECT_TRUE(IsTscInvariant(first + "processor\t: 1\nfla"));
}

}  // namespace
}  // namespace tcs
