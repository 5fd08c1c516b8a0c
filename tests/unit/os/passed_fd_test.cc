#include "coordinator/os/passed_fd.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

namespace tcs {
namespace {

void Send(int socket, int number, int fd) {
  PassedMessage message(&number, sizeof number, std::span(&fd, fd < 0 ? 0 : 1));
  ASSERT_EQ(sendmsg(socket, message.get(), 0), static_cast<ssize_t>(sizeof number));
}

TEST(PassedFd, ACopyComesBesideTheMessageAndClosesAtExec) {
  const auto sockets = SocketPair::Make();
  ASSERT_TRUE(sockets.has_value());
  const UniqueFd file(memfd_create("passed", 0));
  Send(sockets->theirs.get(), 7, file.get());
  int number = 0;
  const Passed passed = ReceivePassed(sockets->ours.get(), &number, sizeof number, 0);
  EXPECT_EQ(passed.size, static_cast<ssize_t>(sizeof number));
  EXPECT_EQ(number, 7);
  ASSERT_TRUE(passed.fd);
  EXPECT_NE(passed.fd.get(), file.get());
  ASSERT_EQ(write(passed.fd.get(), "x", 1), 1);
  EXPECT_EQ(lseek(file.get(), 0, SEEK_CUR), 1);
  EXPECT_EQ(fcntl(passed.fd.get(), F_GETFD), FD_CLOEXEC);
}

TEST(PassedFd, TheKernelSaysWhoHasSentItOnceItIsAsked) {
  const auto sockets = SocketPair::Make();
  ASSERT_TRUE(sockets.has_value());
  const int on = 1;
  ASSERT_EQ(setsockopt(sockets->ours.get(), SOL_SOCKET, SO_PASSCRED, &on, sizeof on), 0);
  Send(sockets->theirs.get(), 7, STDERR_FILENO);
  int number = 0;
  const Passed passed = ReceivePassed(sockets->ours.get(), &number, sizeof number, 0);
  EXPECT_EQ(passed.sender, getpid());
  EXPECT_TRUE(passed.fd);
}

TEST(PassedFd, WithoutADescriptorAndAfterTheEndThereIsNone) {
  auto sockets = SocketPair::Make();
  ASSERT_TRUE(sockets.has_value());
  Send(sockets->theirs.get(), 7, -1);
  int number = 0;
  EXPECT_FALSE(ReceivePassed(sockets->ours.get(), &number, sizeof number, 0).fd);
  EXPECT_EQ(number, 7);
  sockets->theirs.Reset();
  EXPECT_EQ(ReceivePassed(sockets->ours.get(), &number, sizeof number, 0).size, 0);
}

}  // namespace
}  // namespace tcs
