#include "coordinator/os/open_files.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include "coordinator/port/unique_fd.h"

namespace tcs {
namespace {

// Both ways, so that they agree wherever the first is not refused.
bool AreSame(int one, int other) {
  const bool by_set = IsSameFileBySet(one, other);
  EXPECT_EQ(IsSameFile(one, other), by_set);
  return by_set;
}

bool AreAbout(int set, const EpollEntry& entry, int fd) {
  const bool by_set = IsAboutBySet(set, entry, fd);
  EXPECT_EQ(IsAbout(set, entry, fd), by_set);
  return by_set;
}

void AddTo(int set, int fd, std::uint32_t events) {
  epoll_event event{};
  event.events = events;
  ASSERT_EQ(epoll_ctl(set, EPOLL_CTL_ADD, fd, &event), 0);
}

TEST(OpenFiles, ACopyIsTheSameFileAndAnEqualOneIsNot) {
  for (const auto make : {+[] { return eventfd(0, 0); }, +[] { return epoll_create1(0); },
                          +[] { return timerfd_create(CLOCK_MONOTONIC, 0); }}) {
    const UniqueFd one(make()), equal(make()), copy(dup(one.get()));
    EXPECT_TRUE(AreSame(one.get(), one.get()));
    EXPECT_TRUE(AreSame(one.get(), copy.get()));
    EXPECT_TRUE(AreSame(copy.get(), one.get()));
    EXPECT_FALSE(AreSame(one.get(), equal.get()));
    EXPECT_FALSE(AreSame(one.get(), -1));
  }
}

TEST(OpenFiles, ANumberMeansTheFileUntilItIsClosedOrReplaced) {
  const UniqueFd file(eventfd(0, 0)), other(eventfd(0, 0)), copy(dup(file.get()));
  UniqueFd number(dup(file.get()));
  const auto means = [&] { return Means(gettid(), number.get(), copy.get()); };
  if (!means().has_value()) GTEST_SKIP() << "kcmp is refused here";
  EXPECT_EQ(means(), true);
  ASSERT_EQ(dup2(other.get(), number.get()), number.get());
  EXPECT_EQ(means(), false);
  ASSERT_EQ(dup2(file.get(), number.get()), number.get());
  EXPECT_EQ(means(), true);
  const int closed = number.get();
  number.Reset();
  EXPECT_EQ(Means(gettid(), closed, copy.get()), false);
}

TEST(OpenFiles, AnEntryIsAboutTheFileThatHadItsNumberThen) {
  const UniqueFd set(epoll_create1(0)), file(eventfd(0, 0)), other(eventfd(0, 0));
  const UniqueFd copy(dup(file.get()));
  AddTo(set.get(), file.get(), EPOLLIN | EPOLLEXCLUSIVE);
  const std::vector<EpollEntry> entries = EntriesOf(set.get());
  ASSERT_EQ(entries.size(), 1u);
  EXPECT_EQ(entries[0].fd, file.get());
  EXPECT_TRUE(AreAbout(set.get(), entries[0], file.get()));
  EXPECT_TRUE(AreAbout(set.get(), entries[0], copy.get()));
  EXPECT_FALSE(AreAbout(set.get(), entries[0], other.get()));
  // Under its number there is another file now.
  ASSERT_EQ(dup2(other.get(), file.get()), file.get());
  EXPECT_FALSE(AreAbout(set.get(), entries[0], file.get()));
  EXPECT_TRUE(AreAbout(set.get(), entries[0], copy.get()));
}

TEST(OpenFiles, ALookLeavesASetAsItIs) {
  const UniqueFd set(epoll_create1(0)), file(eventfd(1, 0)), other(eventfd(1, 0));
  AddTo(set.get(), file.get(), EPOLLIN | EPOLLET);
  epoll_event event{};
  ASSERT_EQ(epoll_wait(set.get(), &event, 1, 0), 1);
  for (const int fd : {file.get(), other.get()}) {
    IsAboutBySet(set.get(), {file.get(), EPOLLIN}, fd);
    IsSameFileBySet(file.get(), fd);
  }
  EXPECT_EQ(EntriesOf(set.get()).size(), 1u);
  EXPECT_EQ(epoll_wait(set.get(), &event, 1, 0), 0);
}

}  // namespace
}  // namespace tcs
