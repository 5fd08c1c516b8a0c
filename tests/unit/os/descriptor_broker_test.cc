#include "coordinator/os/descriptor_broker.h"

#include <errno.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <utility>

#include "coordinator/os/open_files.h"
#include "coordinator/os/passed_fd.h"
#include "coordinator/port/proc_files.h"
#include "shm/attach_protocol.h"

namespace tcs {
namespace {

// The other end of the connection is with a child of this process, which hands over what it has
// inherited.
class DescriptorBrokerTest : public testing::Test {
 protected:
  void SetUp() override { ASSERT_NE(broker_, nullptr); }
  void TearDown() override {
    if (child_ <= 0) return;
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }

  static bool Answer(int socket, shm::BrokerAnswer answer, int fd) {
    PassedMessage message(&answer, sizeof answer, std::span(&fd, fd < 0 ? 0 : 1));
    return sendmsg(socket, message.get(), MSG_NOSIGNAL) == sizeof answer;
  }
  // Computes for so long before it answers the first time, as one does that gets no processor.
  [[noreturn]] static void HandOver(int socket, int first_s) {
    Answer(socket, {0, 0}, -1);
    shm::BrokerRequest request;
    while (read(socket, &request, sizeof request) == sizeof request) {
      for (const time_t until = time(nullptr) + std::exchange(first_s, 0); time(nullptr) < until;) {
      }
      if (!Answer(socket, {0, request.serial}, request.number)) {
        Answer(socket, {EBADF, request.serial}, -1);
      }
    }
    _exit(0);
  }
  void Begin(int first_s = 0) {
    const UniqueFd end = broker_->TakeClientsEnd();
    child_ = fork();
    if (child_ == 0) HandOver(end.get(), first_s);
    while (!broker_->Is(child_)) usleep(1000);
  }

  int lost_ = 0;
  std::unique_ptr<DescriptorBroker> broker_ = DescriptorBroker::Make([this] { ++lost_; });
  const UniqueFd file_{eventfd(0, 0)};
  pid_t child_ = -1;
};

TEST_F(DescriptorBrokerTest, BeforeItHasComeThereIsNothingToBeHadAndNothingLost) {
  EXPECT_FALSE(broker_->CopyOf(file_.get()));
  EXPECT_EQ(errno, ESRCH);
  broker_->End();
  EXPECT_EQ(lost_, 0);
}

TEST_F(DescriptorBrokerTest, ItHandsOverWhatTheProcessHasUnderANumber) {
  Begin();
  for (int turn = 0; turn < 3; ++turn) {
    const UniqueFd copy = broker_->CopyOf(file_.get());
    ASSERT_TRUE(copy);
    EXPECT_NE(copy.get(), file_.get());
    EXPECT_TRUE(IsSameFileBySet(copy.get(), file_.get()));
  }
  EXPECT_FALSE(broker_->CopyOf(999));
  EXPECT_EQ(errno, EBADF);
  EXPECT_TRUE(broker_->CopyOf(file_.get()));
  EXPECT_EQ(lost_, 0);
}

TEST_F(DescriptorBrokerTest, OneThatWasKilledIsMissedOnce) {
  Begin();
  kill(child_, SIGKILL);
  EXPECT_FALSE(broker_->CopyOf(file_.get()));
  EXPECT_EQ(errno, ESRCH);
  EXPECT_EQ(lost_, 1);
  EXPECT_FALSE(broker_->CopyOf(file_.get()));
  EXPECT_EQ(lost_, 1);
}

TEST_F(DescriptorBrokerTest, OneThatHasGoneIsMissedLikeOneThatGoes) {
  Begin();
  kill(child_, SIGKILL);
  siginfo_t info;
  waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOWAIT);
  EXPECT_FALSE(broker_->CopyOf(file_.get()));
  EXPECT_EQ(errno, ESRCH);
  EXPECT_EQ(lost_, 1);
}

TEST_F(DescriptorBrokerTest, OneThatIsStoppedIsNotWaitedForForEver) {
  Begin();
  kill(child_, SIGSTOP);
  EXPECT_FALSE(broker_->CopyOf(file_.get()));
  EXPECT_EQ(errno, ETIMEDOUT);
  EXPECT_EQ(lost_, 1);
  EXPECT_EQ(ThreadState(child_), 'X');
}

TEST_F(DescriptorBrokerTest, OneThatWouldRunIsWaitedFor) {
  Begin(4);  // at least 3 s
  EXPECT_TRUE(broker_->CopyOf(file_.get()));
  EXPECT_EQ(lost_, 0);
}

TEST_F(DescriptorBrokerTest, ItIsGoneAndReapedOnceItWasEnded) {
  Begin();
  broker_->End();
  EXPECT_EQ(ThreadState(child_), 'X');
  EXPECT_EQ(waitpid(child_, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
  EXPECT_FALSE(broker_->Is(child_));
  EXPECT_EQ(lost_, 0);
  child_ = -1;
}

}  // namespace
}  // namespace tcs
