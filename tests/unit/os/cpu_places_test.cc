#include "coordinator/os/cpu_places.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tcs {
namespace {

using ::testing::ElementsAre;

// Four cores of two threads each, numbered as Linux does on most machines.
const std::vector<CpuPlace> kEight{{0, "0,4"}, {1, "1,5"}, {2, "2,6"}, {3, "3,7"},
                                   {4, "0,4"}, {5, "1,5"}, {6, "2,6"}, {7, "3,7"}};

std::vector<int> Numbers(const cpu_set_t& set) {
  std::vector<int> numbers;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(cpu, &set)) numbers.push_back(cpu);
  }
  return numbers;
}

TEST(CpuPlaces, OneCpuIsEnoughForOneRun) {
  const std::vector<CpuPlace> one{{3, "3"}};
  EXPECT_EQ(RunsAtOnce(one, true), 1);
  EXPECT_EQ(RunsAtOnce(one, false), 1);
  EXPECT_THAT(Numbers(PlaceOfRun(one, true, 1, 0)), ElementsAre(3));
}

TEST(CpuPlaces, OneCpuIsLeftForTheRest) {
  const std::vector<CpuPlace> two{{0, "0"}, {1, "1"}};
  EXPECT_EQ(RunsAtOnce(two, true), 1);
  EXPECT_EQ(RunsAtOnce(kEight, false), 7);
  EXPECT_EQ(Numbers(PlaceOfRun(kEight, false, 7, 6)).size(), 8u) << "a claim leaves out the first";
}

TEST(CpuPlaces, RunsThatMeasureHaveCoresOfTheirOwn) {
  EXPECT_EQ(RunsAtOnce(kEight, true), 3);
  // Zero is for the claim to leave out.
  EXPECT_THAT(Numbers(PlaceOfRun(kEight, true, 3, 0)), ElementsAre(0, 1, 2, 3));
}

TEST(CpuPlaces, TwoThreadsOfTheOnlyCoreAreBetterThanNone) {
  const std::vector<CpuPlace> two{{0, "0-1"}, {1, "0-1"}};
  EXPECT_EQ(RunsAtOnce(two, true), 1);
  EXPECT_THAT(Numbers(PlaceOfRun(two, true, 1, 0)), ElementsAre(0, 1));
}

// A claim may take the first of two (claim_order.h).
TEST(CpuPlaces, ACoreOfItsOwnIsAllThatTheOnlyRunMayUse) {
  const std::vector<CpuPlace> four{{0, "0-1"}, {1, "0-1"}, {2, "2-3"}, {3, "2-3"}};
  EXPECT_EQ(RunsAtOnce(four, true), 1);
  EXPECT_THAT(Numbers(PlaceOfRun(four, true, 1, 0)), ElementsAre(2));
}

TEST(CpuPlaces, MoreRunsShareCores) {
  EXPECT_EQ(Numbers(PlaceOfRun(kEight, true, 4, 0)).size(), 8u);
}

TEST(CpuPlaces, AsManyRunsAsCpusTakeTheFirstToo) {
  EXPECT_THAT(Numbers(PlaceOfRun(kEight, false, 8, 7)), ElementsAre(0));
  EXPECT_EQ(Numbers(PlaceOfRun(kEight, false, 8, 6)).size(), 8u);
}

TEST(CpuPlaces, FurtherCpusAreOfOtherCores) {
  EXPECT_THAT(FurtherCpusOf(kEight, 7, 8), ElementsAre(6, 5, 4));
  EXPECT_THAT(FurtherCpusOf(kEight, 3, 2), ElementsAre(6, 5));
  EXPECT_THAT(FurtherCpusOf(kEight, 0, 0), ElementsAre());
  EXPECT_THAT(FurtherCpusOf({{0, "0-1"}, {1, "0-1"}}, 1, 8), ElementsAre());
}

TEST(CpuPlaces, ThisMachineHasCpus) {
  const std::vector<CpuPlace> cpus = CpuPlaces();
  ASSERT_FALSE(cpus.empty());
  for (const CpuPlace& cpu : cpus) EXPECT_FALSE(cpu.core.empty());
}

}  // namespace
}  // namespace tcs
