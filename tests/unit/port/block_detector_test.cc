#include "coordinator/port/block_detector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <string>
#include <variant>

#include "coordinator/os/cpu_claim.h"
#include "coordinator/os/real_time_facts.h"
#include "coordinator/port/levels.h"

namespace tcs {
namespace {

// The detector may run only when nobody else wants the processor.
constexpr int kLongMs = 100'000, kShortMs = 50;

bool IsReadable(int fd, int timeout_ms) {
  pollfd one{fd, POLLIN, 0};
  return poll(&one, 1, timeout_ms) == 1;
}

// At whatever priority the test may have: this process sleeps, so the detector runs.
class BlockDetectorTest : public testing::Test {
 protected:
  BlockDetectorTest() { EXPECT_EQ(detector_.Start(), ""); }
  BlockDetector detector_;
};

TEST_F(BlockDetectorTest, FiresOnceItIsArmed) {
  EXPECT_FALSE(IsReadable(detector_.fired_fd(), kShortMs));
  detector_.Arm();
  EXPECT_TRUE(detector_.is_armed());
  ASSERT_TRUE(IsReadable(detector_.fired_fd(), kLongMs));
  EXPECT_TRUE(detector_.TakeFired());
  EXPECT_FALSE(detector_.is_armed());
}

TEST_F(BlockDetectorTest, FiresOnceForEachTimeThatItIsArmed) {
  detector_.Arm();
  detector_.Arm();
  ASSERT_TRUE(IsReadable(detector_.fired_fd(), kLongMs));
  EXPECT_TRUE(detector_.TakeFired());
  EXPECT_FALSE(detector_.TakeFired());
  EXPECT_FALSE(IsReadable(detector_.fired_fd(), kShortMs));
  detector_.Arm();
  EXPECT_TRUE(IsReadable(detector_.fired_fd(), kLongMs));
}

TEST_F(BlockDetectorTest, IsToldToHaveEnded) {
  EXPECT_FALSE(detector_.IsDying());
  kill(detector_.pid(), SIGTERM);
  ASSERT_TRUE(IsReadable(detector_.end_fd(), kLongMs));
  EXPECT_TRUE(detector_.IsDying());
  EXPECT_THAT(detector_.HowItEnded(),
              testing::HasSubstr("(process " + std::to_string(detector_.pid()) +
                                 ") was killed by signal 15"));
}

TEST(BlockDetector, EndsItsProcessWithItself) {
  pid_t pid;
  {
    BlockDetector detector;
    ASSERT_EQ(detector.Start(), "");
    pid = detector.pid();
    EXPECT_EQ(kill(pid, 0), 0);
  }
  EXPECT_EQ(kill(pid, 0), -1);
  EXPECT_EQ(errno, ESRCH);
}

// The active thread may compute for ever above the detector, which would hold the locks of what it
// has to unmap as long, or be the first to wait for them: no program on the machine could begin or
// end.
TEST(BlockDetector, HasGivenUpItsMemoryBeforeItSinksBelowThreadsThatCompute) {
  if (const RealTimeFacts facts = AskForRealTime(); facts.error != 0) {
    GTEST_SKIP() << WhyNoRealTime(facts);
  }
  auto claim = ClaimCpu(true);  // or a run that ends there would take the detector's level
  ASSERT_TRUE(std::holds_alternative<CpuClaim>(claim)) << std::get<std::string>(claim);
  const int cpu = std::get<CpuClaim>(claim).cpu;
  cpu_set_t before;
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t spinner = fork();
  if (spinner == 0) {
    alarm(10);  // should the test die
    if (!BindTo(0, cpu) || !SetLevel(0, Level::kActive)) _exit(1);
    if (write(ready[1], "", 1) != 1) _exit(1);
    for (volatile int forever = 1; forever != 0;) {
    }
  }
  char told;
  EXPECT_EQ(read(ready[0], &told, 1), 1);
  EXPECT_TRUE(SetLevel(0, Level::kCoordinator) && BindTo(0, cpu));  // the detector begins there
  {
    BlockDetector detector;
    EXPECT_EQ(detector.Start(), "");
    usleep(300'000);
    std::ifstream maps("/proc/" + std::to_string(detector.pid()) + "/maps");
    const std::string all((std::istreambuf_iterator<char>(maps)), {});
    EXPECT_FALSE(all.empty());
    EXPECT_EQ(all.find('/'), std::string::npos) << all;
    sched_param parameters{};
    EXPECT_EQ(sched_getparam(detector.pid(), &parameters), 0);
    EXPECT_EQ(parameters.sched_priority, static_cast<int>(Level::kDetector));
    kill(spinner, SIGKILL);
  }
  LeaveRealTime(0);
  sched_setaffinity(0, sizeof before, &before);
  int status = 0;
  ASSERT_EQ(waitpid(spinner, &status, 0), spinner);
  EXPECT_TRUE(WIFSIGNALED(status)) << "it computed until it was killed";
  close(ready[0]);
  close(ready[1]);
}

TEST(BlockDetector, ThatWasNeverStartedEndsNothing) {
  const pid_t child = fork();
  if (child == 0) {
    for (;;) pause();
  }
  { const BlockDetector detector; }
  EXPECT_EQ(waitpid(child, nullptr, WNOHANG), 0) << "a child of somebody else's";
  kill(child, SIGKILL);
  EXPECT_EQ(waitpid(child, nullptr, 0), child);
}

}  // namespace
}  // namespace tcs
