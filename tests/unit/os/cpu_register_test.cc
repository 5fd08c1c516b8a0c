#include "coordinator/os/cpu_register.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <vector>

namespace tcs {
namespace {

// No machine has these CPUs, so that only the runs of these tests are met.
constexpr int kCpu = 1021, kOther = 1023;
constexpr std::int64_t kFarAway = std::int64_t{1} << 57;

// A process that does something with a register of its own, and stays until it is killed.
class OtherRun {
 public:
  explicit OtherRun(const std::function<void(CpuRegister&)>& does) {
    int ready[2];
    EXPECT_EQ(pipe(ready), 0);
    pid_ = fork();
    if (pid_ == 0) {
      alarm(60);
      CpuRegister others;
      does(others);
      if (write(ready[1], "", 1) != 1) _exit(1);
      for (;;) pause();
    }
    char told;
    EXPECT_EQ(read(ready[0], &told, 1), 1);
    close(ready[0]);
    close(ready[1]);
  }
  ~OtherRun() { Kill(); }
  OtherRun(const OtherRun&) = delete;
  OtherRun& operator=(const OtherRun&) = delete;

  pid_t pid() const { return pid_; }
  void Kill() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    pid_ = -1;
  }

 private:
  pid_t pid_ = -1;
};

std::vector<pid_t> Waiting(const CpuRegister& others, int cpu) {
  std::vector<pid_t> pids;
  for (const WaitingRun& run : RivalsOf({cpu}, others.Ahead())) pids.push_back(run.pid);
  return pids;
}

TEST(CpuRegister, RunsWaitInTheOrderInWhichTheyCame) {
  const auto queue = [](CpuRegister& others) { others.Queue({kCpu, kOther}); };
  OtherRun first(queue), second(queue);
  CpuRegister own;
  own.Queue({kOther, kCpu});
  OtherRun later(queue);
  EXPECT_EQ(Waiting(own, kCpu), (std::vector<pid_t>{first.pid(), second.pid()}));
  EXPECT_EQ(Waiting(own, kOther), Waiting(own, kCpu));
  EXPECT_TRUE(Waiting(own, kCpu + 1).empty());
}

TEST(CpuRegister, WhoDoesNotWaitSeesAllThatDo) {
  OtherRun one([](CpuRegister& others) { others.Queue({kCpu}); });
  EXPECT_EQ(Waiting(CpuRegister(), kCpu), std::vector<pid_t>{one.pid()});
}

TEST(CpuRegister, NothingIsLeftOfARunThatIsKilled) {
  const auto queue = [](CpuRegister& others) { others.Queue({kCpu}); };
  OtherRun first(queue), second(queue);
  CpuRegister own;
  own.Queue({kCpu});
  first.Kill();
  EXPECT_EQ(Waiting(own, kCpu), std::vector<pid_t>{second.pid()});
  second.Kill();
  EXPECT_TRUE(Waiting(own, kCpu).empty());
}

TEST(CpuRegister, WhoLeavesIsNotWaitedFor) {
  OtherRun one([](CpuRegister& others) {
    others.Queue({kCpu});
    others.Leave();
  });
  EXPECT_TRUE(Waiting(CpuRegister(), kCpu).empty());
}

TEST(CpuRegister, RunsThatShareACpuAreCounted) {
  const auto share = [](CpuRegister& others) { others.Share([] { return kCpu; }); };
  CpuRegister own;
  EXPECT_EQ(own.SharersOf(kCpu), 0u);
  OtherRun first(share), second(share);
  EXPECT_EQ(own.SharersOf(kCpu), 2u);
  EXPECT_EQ(own.SharersOf(kOther), 0u);
  first.Kill();
  EXPECT_EQ(own.SharersOf(kCpu), 1u);
}

TEST(CpuRegister, WhoMovesIsCountedOnce) {
  OtherRun one([](CpuRegister& others) {
    others.Share([] { return kCpu; });
    others.Share([] { return kOther; });
  });
  CpuRegister own;
  EXPECT_EQ(own.SharersOf(kCpu), 0u);
  EXPECT_EQ(own.SharersOf(kOther), 1u);
}

// Of whoever locks bytes of the folder for other reasons.
TEST(CpuRegister, LocksThatAreNoTicketsAreNobodys) {
  OtherRun strange([](CpuRegister&) {
    static RangeLocks* strange_locks = new RangeLocks("/sys/devices/system/cpu");
    strange_locks->Lock(kFarAway, kFarAway + 5000);
  });
  CpuRegister own;
  own.Queue({kCpu});
  EXPECT_TRUE(Waiting(own, kCpu).empty());
}

}  // namespace
}  // namespace tcs
