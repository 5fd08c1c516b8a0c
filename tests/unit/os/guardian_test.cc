#include "coordinator/os/guardian.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "coordinator/os/cpu_claim.h"

namespace tcs {
namespace {

// The guardian in a process of its own, as tcsim runs it; its stderr is closed, unless it `speaks`.
pid_t Guard(int (*coordinate)(), GuardLimits limits, bool speaks = false) {
  const pid_t pid = fork();
  if (pid != 0) return pid;
  setpgid(0, 0);  // a group that is left with somebody who was stopped is sent SIGHUP
  if (!speaks) close(STDERR_FILENO);
  _exit(RunGuarded(coordinate, limits));
}

// On a busy host it may take long to say where one went astray.
constexpr GuardLimits kLooksSoon{.look_every_s = 1, .say_within_s = 60};

int StatusOf(pid_t pid) {
  int status = -1;
  waitpid(pid, &status, 0);
  return status;
}

// What those processes tell that only they know.
int g_told[2];

void Tell(pid_t pid) { EXPECT_EQ(write(g_told[1], &pid, sizeof pid), ssize_t{sizeof pid}); }

pid_t Told() {
  pid_t pid = -1;
  EXPECT_EQ(read(g_told[0], &pid, sizeof pid), ssize_t{sizeof pid});
  return pid;
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
  Tell(getpid());
  for (;;) pause();
  return 0;
}

TEST(Guardian, TheExitStatusIsTheCoordinators) {
  const int status = StatusOf(Guard([] { return 7; }, {}));
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 7);
}

TEST(Guardian, ACoordinatorThatGoesAstrayIsKilled) {
  const int status = StatusOf(Guard(GoAstray, kLooksSoon));
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGABRT);
}

TEST(Guardian, ItSaysWhereItWentAstray) {
  EXPECT_EXIT(_exit(WTERMSIG(StatusOf(Guard(GoAstray, kLooksSoon, true)))),
              testing::ExitedWithCode(SIGABRT),
              "is killed; this is a fault of tcsim.*\n.*where it was.*\n.*\\(\\+0x[0-9a-f]+\\)");
}

TEST(Guardian, OneThatCannotSayWhereIsKilledAllTheSame) {
  const auto mute = [] {
    signal(SIGABRT, SIG_IGN);
    return GoAstray();
  };
  const int status = StatusOf(Guard(mute, {.look_every_s = 1}));
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGKILL);
}

TEST(Guardian, OneThatComputesAndGetsOnIsNot) {
  const int status = StatusOf(Guard(ComputeAndGetOn, {.look_every_s = 1}));
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 5);
}

TEST(Guardian, OneThatDoesNotStopIsKilled) {
  ASSERT_EQ(pipe(g_told), 0);
  const pid_t guardian = Guard(IgnoreSigterm, {.stop_within_s = 1});
  EXPECT_GT(Told(), 0);
  kill(guardian, SIGTERM);
  const int status = StatusOf(guardian);
  close(g_told[0]);
  close(g_told[1]);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGKILL);
}

TEST(Guardian, ACoordinatorThatIsStoppedGoesOn) {
  const int status = StatusOf(Guard(
      [] {
        raise(SIGSTOP);
        return 3;
      },
      {}));
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 3);
}

// Tells of itself, and of a child that has left it for good.
int LiveOn() {
  if (fork() == 0) {
    setsid();
    if (fork() != 0) _exit(0);
    for (const int signal : {SIGTERM, SIGHUP, SIGINT}) ::signal(signal, SIG_IGN);
    Tell(getpid());
    for (;;) pause();
  }
  Tell(getpid());
  for (;;) pause();
  return 0;
}

// What /proc/PID/stat has behind the name: the state, a space, and the parent; nothing if there is
// no such process.
std::string StateAndParentOf(pid_t pid) {
  char path[64], text[512] = {};
  snprintf(path, sizeof path, "/proc/%d/stat", pid);
  FILE* file = fopen(path, "re");
  if (file == nullptr) return {};
  const std::size_t n = fread(text, 1, sizeof text - 1, file);
  fclose(file);
  const char* end = n > 0 ? strrchr(text, ')') : nullptr;
  return end == nullptr ? "" : end + 2;
}

pid_t ParentOf(pid_t pid) {
  const std::string stat = StateAndParentOf(pid);
  return stat.empty() ? -1 : atoi(stat.c_str() + 2);
}

// A container's first process need not reap those whose parent has ended.
bool EndsSoon(pid_t pid) {
  for (int turn = 0; turn < 5'000; ++turn) {
    const std::string stat = StateAndParentOf(pid);
    if (stat.empty() || stat[0] == 'Z' || stat[0] == 'X') return true;
    usleep(20'000);
  }
  return false;
}

// Of the two that LiveOn tells of: the coordinator, whose parent is the keeper.
class WhoeverIsKilled : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(pipe(g_told), 0);
    guardian_ = fork();
    if (guardian_ == 0) {
      setpgid(0, 0);
      close(STDERR_FILENO);
      _exit(RunGuarded(LiveOn, {.look_every_s = 1, .stop_within_s = 1}));
    }
    const pid_t one = Told(), other = Told();
    const bool first = ParentOf(ParentOf(one)) == guardian_ && getpgid(one) == guardian_;
    coordinator_ = first ? one : other;
    far_child_ = first ? other : one;
    keeper_ = ParentOf(coordinator_);
  }
  void TearDown() override {
    EXPECT_TRUE(EndsSoon(coordinator_)) << coordinator_;
    EXPECT_TRUE(EndsSoon(far_child_)) << far_child_;
    EXPECT_TRUE(EndsSoon(keeper_)) << keeper_;
    close(g_told[0]);
    close(g_told[1]);
  }

  pid_t guardian_ = -1, keeper_ = -1, coordinator_ = -1, far_child_ = -1;
};

TEST_F(WhoeverIsKilled, TheGuardian) {
  kill(guardian_, SIGKILL);
  EXPECT_TRUE(WIFSIGNALED(StatusOf(guardian_)));
}

TEST_F(WhoeverIsKilled, TheKeeper) {
  kill(keeper_, SIGKILL);
  EXPECT_TRUE(WIFSIGNALED(StatusOf(guardian_)));
}

TEST_F(WhoeverIsKilled, TheCoordinator) {
  kill(coordinator_, SIGKILL);
  EXPECT_TRUE(WIFSIGNALED(StatusOf(guardian_)));
}

TEST_F(WhoeverIsKilled, TheWholeJob) {
  kill(-guardian_, SIGKILL);
  EXPECT_TRUE(WIFSIGNALED(StatusOf(guardian_)));
}

TEST_F(WhoeverIsKilled, TheGuardianOfAStoppedCoordinator) {
  kill(coordinator_, SIGSTOP);
  kill(guardian_, SIGKILL);
  EXPECT_TRUE(WIFSIGNALED(StatusOf(guardian_)));
}

TEST_F(WhoeverIsKilled, ACoordinatorThatATracerHolds) {
  ASSERT_EQ(ptrace(PTRACE_SEIZE, coordinator_, nullptr, nullptr), 0);
  ASSERT_EQ(ptrace(PTRACE_INTERRUPT, coordinator_, nullptr, nullptr), 0);
  int status = 0;
  EXPECT_EQ(waitpid(coordinator_, &status, __WALL), coordinator_);
  // Its end is the tracer's to see first.
  EXPECT_EQ(waitpid(coordinator_, &status, __WALL), coordinator_);
  EXPECT_TRUE(WIFSIGNALED(status)) << status;
  EXPECT_TRUE(WIFSIGNALED(StatusOf(guardian_)));
}

int CpuOf(const std::variant<CpuClaim, std::string>& claimed) {
  const auto* claim = std::get_if<CpuClaim>(&claimed);
  return claim == nullptr ? -1 : claim->cpu;
}

// As a run does; tells of itself and of its CPU, -1 if other runs have all.
int ClaimAndLive() {
  const auto claim = ClaimCpu(false);
  Tell(getpid());
  Tell(CpuOf(claim));
  for (;;) pause();
  return 0;
}

class Claims : public ::testing::Test {
 protected:
  void Begin(int (*coordinate)()) {
    ASSERT_EQ(pipe(g_told), 0);
    guardian_ = Guard(coordinate, {});
    coordinator_ = Told();
    cpu_ = Told();
    keeper_ = ParentOf(coordinator_);
  }
  void TearDown() override {
    kill(guardian_, SIGTERM);
    StatusOf(guardian_);
    close(g_told[0]);
    close(g_told[1]);
  }

  pid_t guardian_ = -1, keeper_ = -1, coordinator_ = -1;
  int cpu_ = -1;
};

// Whoever clears the CPU of a dead coordinator's threads would otherwise meet another run's.
TEST_F(Claims, OfACoordinatorThatIsKilledEndsWithTheGuardian) {
  Begin(ClaimAndLive);
  if (cpu_ < 0) GTEST_SKIP() << "other runs have the processors";
  kill(guardian_, SIGSTOP);
  kill(keeper_, SIGSTOP);
  kill(coordinator_, SIGKILL);
  EXPECT_TRUE(EndsSoon(coordinator_));
  EXPECT_TRUE(IsClaimed(cpu_));
  kill(keeper_, SIGCONT);
  EXPECT_TRUE(EndsSoon(keeper_));
  EXPECT_TRUE(IsClaimed(cpu_));
  kill(guardian_, SIGCONT);
}

// Others may have it for a while, but the guardian would have it until it ends.
bool IsFreeSometime(int cpu) {
  for (int turn = 0; turn < 20'000; ++turn) {
    if (!IsClaimed(cpu)) return true;
    usleep(5'000);
  }
  return false;
}

TEST_F(Claims, ThatIsGivenBackIsEverybodys) {
  Begin([] {
    const int cpu = CpuOf(ClaimCpu(false));
    Tell(getpid());
    Tell(cpu);
    for (;;) pause();
    return 0;
  });
  if (cpu_ < 0) GTEST_SKIP() << "other runs have the processors";
  EXPECT_TRUE(IsFreeSometime(cpu_));
}

}  // namespace
}  // namespace tcs
