#include "coordinator/port/unique_fd.h"

#include <errno.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <utility>

namespace tcs {
namespace {

int NewFd() { return open("/dev/null", O_RDONLY | O_CLOEXEC); }
bool IsOpen(int fd) { return fcntl(fd, F_GETFD) >= 0; }

TEST(UniqueFdTest, NoneAtFirst) {
  const UniqueFd fd;
  EXPECT_FALSE(fd);
  EXPECT_EQ(fd.get(), -1);
  // As calls return it that fail.
  EXPECT_EQ(UniqueFd(-5).get(), -1);
}

TEST(UniqueFdTest, IsClosedWithItsOwner) {
  const int number = NewFd();
  {
    const UniqueFd fd(number);
    EXPECT_TRUE(fd);
    EXPECT_EQ(fd.get(), number);
    EXPECT_TRUE(IsOpen(number));
  }
  EXPECT_FALSE(IsOpen(number));
}

TEST(UniqueFdTest, MovesToAnotherOwner) {
  const int number = NewFd(), old = NewFd();
  UniqueFd other(old);
  {
    UniqueFd fd(number);
    other = std::move(fd);
    EXPECT_FALSE(fd);
  }
  EXPECT_FALSE(IsOpen(old));
  EXPECT_TRUE(IsOpen(number));
  const UniqueFd last(std::move(other));
  EXPECT_EQ(last.get(), number);
  EXPECT_EQ(other.get(), -1);
}

TEST(UniqueFdTest, MovedToItselfItStays) {
  UniqueFd fd(NewFd());
  UniqueFd& same = fd;
  fd = std::move(same);
  EXPECT_TRUE(IsOpen(fd.get()));
}

TEST(UniqueFdTest, IsGivenAway) {
  const int number = NewFd();
  {
    UniqueFd fd(number);
    EXPECT_EQ(fd.Release(), number);
    EXPECT_FALSE(fd);
  }
  EXPECT_TRUE(IsOpen(number));
  close(number);
}

TEST(UniqueFdTest, AnotherTakesItsPlace) {
  const int number = NewFd(), next = NewFd();
  UniqueFd fd(number);
  fd.Reset(next);
  EXPECT_FALSE(IsOpen(number));
  EXPECT_EQ(fd.get(), next);
  fd.Reset();
  EXPECT_FALSE(fd);
  EXPECT_FALSE(IsOpen(next));
}

TEST(UniqueFdTest, ClosingKeepsErrno) {
  const int number = NewFd();
  UniqueFd fd(number);
  close(number);  // so that its own close fails
  errno = ENOENT;
  fd.Reset();
  EXPECT_EQ(errno, ENOENT);
}

}  // namespace
}  // namespace tcs
