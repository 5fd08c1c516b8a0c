#include "coordinator/os/guardian.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

namespace tcs {
namespace {

// The guardian in a process of its own, as tcsim runs it; its stderr is closed.
pid_t Guard(int (*coordinate)(), GuardLimits limits) {
  const pid_t pid = fork();
  if (pid != 0) return pid;
  close(STDERR_FILENO);
  _exit(RunGuarded(coordinate, limits));
}

int StatusOf(pid_t pid) {
  int status = -1;
  waitpid(pid, &status, 0);
  return status;
}

// At a real-time priority, as a coordinator has it: at another one it would not have the processor
// for itself on a machine that does other things, too.
int GoAstray() {
  const sched_param param{.sched_priority = 1};
  sched_setscheduler(0, SCHED_FIFO, &param);
  for (volatile int forever = 1; forever != 0;) {
  }
  return 0;
}

int ComputeAndGetOn() {
  timespec start, now;
  clock_gettime(CLOCK_MONOTONIC, &start);
  do {
    Beat();
    clock_gettime(CLOCK_MONOTONIC, &now);
  } while (now.tv_sec < start.tv_sec + 4);
  return 5;
}

int IgnoreSigterm() {
  signal(SIGTERM, SIG_IGN);
  for (;;) pause();
  return 0;
}

TEST(Guardian, TheExitStatusIsTheCoordinators) {
  const int status = StatusOf(Guard([] { return 7; }, {}));
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 7);
}

TEST(Guardian, ACoordinatorThatGoesAstrayIsKilled) {
  const int status = StatusOf(Guard(GoAstray, {.look_every_s = 1}));
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGKILL);
}

TEST(Guardian, OneThatComputesAndGetsOnIsNot) {
  const int status = StatusOf(Guard(ComputeAndGetOn, {.look_every_s = 1}));
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 5);
}

TEST(Guardian, OneThatDoesNotStopIsKilled) {
  const pid_t guardian = Guard(IgnoreSigterm, {.stop_within_s = 1});
  usleep(300'000);
  kill(guardian, SIGTERM);
  const int status = StatusOf(guardian);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGKILL);
}

}  // namespace
}  // namespace tcs
