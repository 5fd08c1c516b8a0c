#include "coordinator/port/block_detector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <string>

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
