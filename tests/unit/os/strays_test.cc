#include "coordinator/os/strays.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "coordinator/os/cpu_claim.h"
#include "coordinator/os/real_time_facts.h"
#include "coordinator/port/levels.h"

namespace tcs {
namespace {

class Strays : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const RealTimeFacts facts = AskForRealTime(); facts.error != 0) {
      GTEST_SKIP() << WhyNoRealTime(facts);
    }
    auto claim = ClaimCpu(true);  // nobody else's threads are lowered
    ASSERT_TRUE(std::holds_alternative<CpuClaim>(claim)) << std::get<std::string>(claim);
    claim_ = std::move(std::get<CpuClaim>(claim));
  }
  void TearDown() override {
    for (const pid_t pid : made_) {
      kill(pid, SIGKILL);
      waitpid(pid, nullptr, 0);
    }
  }

  // A child that waits or spins, for a minute at most, with that priority.
  pid_t Make(int priority, bool bound, bool spins) {
    int ready[2];
    EXPECT_EQ(pipe(ready), 0);
    const pid_t pid = fork();
    if (pid == 0) {
      alarm(60);
      cpu_set_t cpus;
      CPU_ZERO(&cpus);
      CPU_SET(static_cast<std::size_t>(claim_.cpu), &cpus);
      if (bound) sched_setaffinity(0, sizeof cpus, &cpus);
      const sched_param param{priority};
      sched_setscheduler(0, SCHED_FIFO, &param);
      if (write(ready[1], "", 1) != 1) _exit(1);
      while (!spins) pause();
      for (volatile int forever = 1; forever != 0;) {
      }
    }
    char told;
    EXPECT_EQ(read(ready[0], &told, 1), 1);
    close(ready[0]);
    close(ready[1]);
    made_.push_back(pid);
    return pid;
  }

  CpuClaim claim_{};
  std::vector<pid_t> made_;
};

TEST_F(Strays, ThreadsOfTheCpuLoseTheirRealTimePriority) {
  const pid_t waits = Make(static_cast<int>(Level::kWaiting), true, false);
  const pid_t spins = Make(static_cast<int>(Level::kActive), true, true);
  LowerStraysOn(claim_.cpu, MostPids());
  EXPECT_EQ(sched_getscheduler(waits), SCHED_OTHER);
  EXPECT_EQ(sched_getscheduler(spins), SCHED_OTHER);
}

TEST_F(Strays, ThoseOfOthersKeepIt) {
  const pid_t unbound = Make(static_cast<int>(Level::kActive), false, false);
  const pid_t higher = Make(static_cast<int>(Level::kKernelOnly) + 1, true, false);
  LowerStraysOn(claim_.cpu, MostPids());
  EXPECT_EQ(sched_getscheduler(unbound), SCHED_FIFO);
  EXPECT_EQ(sched_getscheduler(higher), SCHED_FIFO);
}

}  // namespace
}  // namespace tcs
