#include "coordinator/port/bare_process.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sched.h>
#include <sys/eventfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <fstream>
#include <string>

namespace tcs {
namespace {

constexpr int kPatienceMs = 100'000;  // it may run only when nobody else wants the processor

class BareProcessTest : public testing::TestWithParam<bool> {
 protected:
  BareProcessTest() {
    child_ = fork();
    if (child_ != 0) return;
    dup2(asked_, 0);
    dup2(answered_, 1);
    RelayInBareProcess(GetParam() ? SCHED_IDLE : SCHED_OTHER, 0);
    _exit(1);
  }
  ~BareProcessTest() override {
    close(asked_);
    close(answered_);
    if (child_ <= 0) return;  // to signal -1 is to signal everybody
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }
  bool Relays() {
    const std::uint64_t one = 1;
    if (write(asked_, &one, sizeof one) != sizeof one) return false;
    pollfd fd{answered_, POLLIN, 0};
    std::uint64_t count = 0;
    return poll(&fd, 1, kPatienceMs) == 1 &&
           read(answered_, &count, sizeof count) == sizeof count && count == 1;
  }
  std::string Memory() const {
    std::ifstream maps("/proc/" + std::to_string(child_) + "/maps");
    std::string all;
    for (std::string line; std::getline(maps, line);) all += line + "\n";
    return all;
  }

  int asked_ = eventfd(0, 0), answered_ = eventfd(0, 0);
  pid_t child_ = -1;
};

TEST_P(BareProcessTest, RelaysAsOftenAsItIsAsked) {
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(Relays()) << i;
}

// A library among it would have to be unmapped when the process dies.
TEST_P(BareProcessTest, HasNoMemoryOfAnyFile) {
  ASSERT_TRUE(Relays());
  const std::string memory = Memory();
  EXPECT_FALSE(memory.empty());
  EXPECT_EQ(memory.find('/'), std::string::npos) << memory;
  EXPECT_EQ(memory.find("[stack"), std::string::npos) << memory;
}

TEST_P(BareProcessTest, RunsWhereItWasToldTo) {
  ASSERT_TRUE(Relays());
  EXPECT_EQ(sched_getscheduler(child_), GetParam() ? SCHED_IDLE : SCHED_OTHER);
}

TEST_P(BareProcessTest, IsEndedByASignal) {
  ASSERT_TRUE(Relays());
  ASSERT_EQ(kill(child_, SIGTERM), 0);
  int status = 0;
  ASSERT_EQ(waitpid(child_, &status, 0), child_);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGTERM);
  child_ = -1;
}

INSTANTIATE_TEST_SUITE_P(Levels, BareProcessTest, testing::Bool(), [](const auto& its) {
  return std::string(its.param ? "Idle" : "Ordinary");
});

}  // namespace
}  // namespace tcs
