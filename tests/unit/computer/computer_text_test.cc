#include "coordinator/computer/computer_text.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

TEST(ComputerText, CoresAreListedAsTheKernelListsThem) {
  EXPECT_EQ(CoreList(0b1), "0");
  EXPECT_EQ(CoreList(0b1101110), "1-3,5-6");
  EXPECT_EQ(CoreList(AllCores(64)), "0-63");
  EXPECT_EQ(CoreList(0), "");
  EXPECT_EQ(CoreMask(0b1, 1), "1");
  EXPECT_EQ(CoreMask(0b101, 6), "05");
  EXPECT_EQ(CoreMask(AllCores(32), 32), "ffffffff");
  EXPECT_EQ(CoreMask(AllCores(33), 33), "1,ffffffff");
  EXPECT_EQ(CoreMask(1, 64), "00000000,00000001");
}

TEST(ComputerText, AProcessorTableHasTheRobotsCores) {
  const std::string host =
      "processor\t: 0\nmodel name\t: X\nphysical id\t: 3\nsiblings\t: 8\ncore id\t\t: 5\n"
      "cpu cores\t: 4\napicid\t\t: 9\npower management:\n\n"
      "processor\t: 1\nmodel name\t: Y\n\n";
  const std::string table = ProcessorTable(host, 3);
  EXPECT_EQ(table,
            "processor\t: 0\nmodel name\t: X\nphysical id\t: 0\nsiblings\t: 3\ncore id\t\t: 0\n"
            "cpu cores\t: 3\napicid\t\t: 0\npower management:\n\n"
            "processor\t: 1\nmodel name\t: Y\n\n"
            "processor\t: 2\nmodel name\t: X\nphysical id\t: 0\nsiblings\t: 3\ncore id\t\t: 2\n"
            "cpu cores\t: 3\napicid\t\t: 2\npower management:\n\n");
  EXPECT_EQ(ProcessorTable("", 3), "");
}

TEST(ComputerText, UptimeAndIdleTimeOfAllCores) {
  EXPECT_EQ(UptimeText(1000 * kSecond + 50'000'000, {200 * kSecond, 0}), "1000.05 1800.10\n");
}

TEST(ComputerText, CountersOfEachCoreAndOfAll) {
  const std::string text = CountersText({.uptime_ns = 100 * kSecond,
                                         .boot_date_ns = 1700 * kSecond,
                                         .busy_ns = {30 * kSecond, 10 * kSecond},
                                         .switches = 7,
                                         .processes = 3,
                                         .running = 2});
  EXPECT_EQ(text.substr(0, text.find("intr")),
            "cpu  4000 0 0 16000 0 0 0 0 0 0\ncpu0 3000 0 0 7000 0 0 0 0 0 0\n"
            "cpu1 1000 0 0 9000 0 0 0 0 0 0\n");
  EXPECT_NE(text.find("\nctxt 7\nbtime 1700\nprocesses 3\nprocs_running 2\n"), std::string::npos);
}

// The name may hold anything.
std::string Stat(char state) {
  return std::string("12 (a) b) c) ") + state +
         " 1 12 12 0 -1 4194304 93 0 0 0 400 100 50 25 20 0 1 0 12345 1000 2 18446744073709551615"
         " 1 1 0 0 0 0 0 0 0 0 0 0 17 1 0 0 0 0 0 0 0 0 0 0 0 0 0\n";
}

TEST(ComputerText, AProcessHasComputedWhatTheRobotSays) {
  const std::string text = ProcessCounters(Stat('S'), {.user_ns = 2 * kSecond,
                                                       .system_ns = kSecond / 2,
                                                       .children_ns = 3 * kSecond,
                                                       .started_ns = 1001 * kSecond,
                                                       .state = 'R',
                                                       .core = 3,
                                                       .policy = 1,
                                                       .real_time_priority = 40});
  EXPECT_EQ(text,
            "12 (a) b) c) R 1 12 12 0 -1 4194304 93 0 0 0 200 50 300 0 -41 0 1 0 100100 1000 2 "
            "18446744073709551615 1 1 0 0 0 0 0 0 0 0 0 0 17 3 40 1 0 0 0 0 0 0 0 0 0 0 0\n");
  EXPECT_EQ(TicksIn(Stat('S')).user, 400);
  EXPECT_EQ(TicksIn(Stat('S')).system, 100);
}

TEST(ComputerText, AStateThatTheRobotDoesNotKnowIsKept) {
  EXPECT_NE(ProcessCounters(Stat('T'), {}).find("c) T 1"), std::string::npos);
  EXPECT_NE(ProcessCounters(Stat('Z'), {}).find("c) Z 1"), std::string::npos);
}

TEST(ComputerText, ProcessesOutsideBeganBeforeTheRobotWasOnOrLater) {
  EXPECT_NE(OutsideProcessCounters(Stat('S'), 55).find(" 12400 1000 "), std::string::npos);
  EXPECT_NE(OutsideProcessCounters(Stat('S'), -20000).find(" 0 1000 "), std::string::npos);
}

TEST(ComputerText, WhatIsNoStatIsNoFault) {
  EXPECT_EQ(OutsideProcessCounters("", 1), "\n");
  EXPECT_EQ(TicksIn("nothing").user, 0);
}

TEST(ComputerText, AStatusHasTheCoresThatMayBeUsed) {
  EXPECT_EQ(ProcessStatus("Name:\ta\nState:\tS (sleeping)\nCpus_allowed:\tff\n"
                          "Cpus_allowed_list:\t0-7\nMems_allowed:\t1\n",
                          'R', 0b101, 4),
            "Name:\ta\nState:\tR (running)\nCpus_allowed:\t5\nCpus_allowed_list:\t0,2\n"
            "Mems_allowed:\t1\n");
  EXPECT_EQ(ProcessStatus("State:\tT (stopped)\n", 'R', 1, 1), "State:\tT (stopped)\n");
}

}  // namespace
}  // namespace tcs
