#include "coordinator/tasks/usage.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

TEST(EndedThreads, ThoseWhoseClocksCanBeReadCountFromWhereTheyBegan) {
  EndedThreads ended;
  ended.Add({.charged_ns = 70, .activations = 2}, 100, 30, 0);
  ended.Add({.charged_ns = 40, .stolen_ns = 5}, 45, 5, 0);
  ended.Complete(145);
  EXPECT_EQ(ended.usage().charged_ns, 110);
  EXPECT_EQ(ended.usage().host_cpu_ns, 110);
  EXPECT_EQ(ended.usage().stolen_ns, 5);
  EXPECT_EQ(ended.usage().activations, 2);
}

TEST(EndedThreads, TheProcessesClockHasWhatKilledThreadsHad) {
  EndedThreads ended;
  ended.Add({.charged_ns = 70}, 100, 30, 0);
  ended.Add({.charged_ns = 50}, -1, 10, 50);
  ended.Add({.charged_ns = 20}, -1, 5, 20);
  ended.Complete(100 + 62 + 25);
  EXPECT_EQ(ended.usage().host_cpu_ns, 70 + 52 + 20);
}

TEST(EndedThreads, WithoutThatClockTheyHadWhatTheyWereCharged) {
  EndedThreads ended;
  ended.Add({.charged_ns = 50}, -1, 10, 50);
  ended.Complete(-1);
  EXPECT_EQ(ended.usage().host_cpu_ns, 50);
}

TEST(EndedThreads, AfterAnExecByAnotherThreadThatClockIsNotAsked) {
  EndedThreads ended;
  ended.Add({.charged_ns = 50}, -1, 10, 50);
  ended.NoteChangedClocks();
  ended.Complete(500);
  EXPECT_EQ(ended.usage().host_cpu_ns, 50);
}

}  // namespace
}  // namespace tcs
