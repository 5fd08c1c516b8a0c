#include "coordinator/tasks/reactor.h"

#include <gtest/gtest.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace tcs {
namespace {

// An eventfd that can be read at once, or once it is told to.
class Source {
 public:
  explicit Source(unsigned value = 1) : fd_(eventfd(value, EFD_NONBLOCK)) {}
  ~Source() { close(fd_); }
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  int fd() const { return fd_; }
  void Fire() const { EXPECT_EQ(eventfd_write(fd_, 1), 0); }
  void Clear() const {
    eventfd_t value;
    EXPECT_EQ(eventfd_read(fd_, &value), 0);
  }

 private:
  int fd_;
};

struct Seen {
  Subject subject;
  std::uint32_t events;
  VirtualTime at;
};

Reactor::Handler Noting(std::vector<Seen>* seen, PollOutcome found = {}) {
  return [seen, found](const Subject& subject, std::uint32_t events, EventTime when) {
    seen->push_back({subject, events, when.at});
    return found;
  };
}

TEST(Reactor, HandsEventsToTheHandlerOfTheirKindAtTheMoment) {
  Reactor reactor;
  std::vector<Seen> pipes, awaited;
  reactor.On(Tag::kPipe, Noting(&pipes));
  reactor.On(Tag::kAwaited, Noting(&awaited));
  const Source one, other;
  const Subject pipe{Tag::kPipe, 7}, wait{Tag::kAwaited, 0xffffffff, 0xabcdef};
  ASSERT_TRUE(reactor.Add(one.fd(), EPOLLIN, pipe));
  ASSERT_TRUE(reactor.Add(other.fd(), EPOLLIN | EPOLLONESHOT, wait));
  EXPECT_EQ(reactor.Wait(HostNs(0)), 2u);
  EXPECT_FALSE(reactor.IsFull());
  reactor.Handle({.at = RobotTime(42)});
  ASSERT_EQ(pipes.size(), 1u);
  EXPECT_EQ(pipes[0].subject, pipe);
  EXPECT_EQ(pipes[0].events, static_cast<std::uint32_t>(EPOLLIN));
  EXPECT_EQ(pipes[0].at, RobotTime(42));
  ASSERT_EQ(awaited.size(), 1u);
  EXPECT_EQ(awaited[0].subject, wait);
}

TEST(Reactor, AnEventIsHandledOnce) {
  Reactor reactor;
  std::vector<Seen> seen;
  reactor.On(Tag::kPipe, Noting(&seen));
  const Source source;
  ASSERT_TRUE(reactor.Add(source.fd(), EPOLLIN, {Tag::kPipe}));
  reactor.Wait(HostNs(0));
  reactor.Handle({});
  reactor.Handle({});
  EXPECT_EQ(seen.size(), 1u);
  source.Clear();
  EXPECT_EQ(reactor.Wait(HostNs(0)), 0u);
}

TEST(Reactor, WhatHandlersFindAddsUp) {
  Reactor reactor;
  std::vector<Seen> seen;
  reactor.On(Tag::kPipe, Noting(&seen, {.stops_running = true}));
  reactor.On(Tag::kDetector, Noting(&seen, {.blocks_running = true, .looks_again = true}));
  const Source one, other;
  reactor.Add(one.fd(), EPOLLIN, {Tag::kPipe});
  reactor.Add(other.fd(), EPOLLIN, {Tag::kDetector});
  reactor.Wait(HostNs(0));
  const PollOutcome found = reactor.Handle({});
  EXPECT_TRUE(found.stops_running);
  EXPECT_TRUE(found.blocks_running);
  EXPECT_TRUE(found.looks_again);
  EXPECT_FALSE(found.wakes_others);
}

TEST(Reactor, ModifiesWhatIsThereOnly) {
  Reactor reactor;
  std::vector<Seen> seen;
  reactor.On(Tag::kAwaited, Noting(&seen));
  const Source source;
  EXPECT_FALSE(reactor.Modify(source.fd(), EPOLLIN, {Tag::kAwaited, 1, 1}));
  EXPECT_TRUE(reactor.Add(source.fd(), EPOLLIN | EPOLLONESHOT, {Tag::kAwaited, 1, 1}));
  EXPECT_FALSE(reactor.Add(source.fd(), EPOLLIN, {Tag::kAwaited, 1, 1}));
  reactor.Wait(HostNs(0));
  reactor.Handle({});
  EXPECT_EQ(reactor.Wait(HostNs(0)), 0u);  // once only
  EXPECT_TRUE(reactor.Modify(source.fd(), EPOLLIN | EPOLLONESHOT, {Tag::kAwaited, 1, 2}));
  reactor.Wait(HostNs(0));
  reactor.Handle({});
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen[1].subject.number, 2u);
  reactor.Remove(source.fd());
  reactor.Remove(source.fd());
  EXPECT_EQ(reactor.Wait(HostNs(0)), 0u);
}

TEST(Reactor, SaysWhetherThereMayBeMore) {
  Reactor reactor;
  std::vector<Seen> seen;
  reactor.On(Tag::kPipe, Noting(&seen));
  std::vector<std::unique_ptr<Source>> sources;
  for (std::uint32_t i = 0; i < 100; ++i) {
    sources.push_back(std::make_unique<Source>());
    ASSERT_TRUE(reactor.Add(sources.back()->fd(), EPOLLIN | EPOLLONESHOT, {Tag::kPipe, i}));
  }
  const std::uint64_t look = reactor.next_look();
  reactor.Wait(HostNs(0));
  EXPECT_TRUE(reactor.IsFull());
  EXPECT_EQ(reactor.next_look(), look) << "of which this was only a part";
  reactor.Handle({});
  reactor.Wait(HostNs(0));
  EXPECT_FALSE(reactor.IsFull());
  EXPECT_EQ(reactor.next_look(), look + 1);
  reactor.Handle({});
  ASSERT_EQ(seen.size(), 100u);
  std::vector<bool> found(100);
  for (const Seen& one : seen) found[one.subject.index] = true;
  EXPECT_EQ(std::count(found.begin(), found.end(), true), 100);
}

TEST(Reactor, SaysWhetherSomethingHasComeSince) {
  Reactor reactor;
  std::vector<Seen> seen;
  reactor.On(Tag::kPipe, Noting(&seen));
  const Source first;
  EXPECT_FALSE(reactor.HasMore());
  ASSERT_TRUE(reactor.Add(first.fd(), EPOLLIN | EPOLLONESHOT, {Tag::kPipe, 1}));
  EXPECT_TRUE(reactor.HasMore());
  reactor.Wait(HostNs(0));
  EXPECT_FALSE(reactor.HasMore());
  const Source second;
  ASSERT_TRUE(reactor.Add(second.fd(), EPOLLIN | EPOLLONESHOT, {Tag::kPipe, 2}));
  EXPECT_TRUE(reactor.HasMore());
  reactor.Handle({});
  EXPECT_TRUE(reactor.HasMore()) << "what is queued and what has come since are two things";
  EXPECT_EQ(seen.size(), 1u);
}

TEST(Reactor, AHandlerMayLetItsDescriptorGo) {
  Reactor reactor;
  const Source source(0);
  int handled = 0;
  reactor.On(Tag::kTrap, [&](const Subject&, std::uint32_t, EventTime) {
    ++handled;
    reactor.Remove(source.fd());
    return PollOutcome{};
  });
  reactor.Add(source.fd(), EPOLLIN, {Tag::kTrap});
  source.Fire();
  reactor.Wait(HostNs(-1));
  reactor.Handle({});
  EXPECT_EQ(reactor.Wait(HostNs(0)), 0u);
  EXPECT_EQ(handled, 1);
}

TEST(ReactorDeathTest, WaitingInAHandlerIsABug) {
  Reactor reactor;
  const Source source;
  reactor.On(Tag::kPipe, [&](const Subject&, std::uint32_t, EventTime) {
    reactor.Wait(HostNs(0));
    return PollOutcome{};
  });
  reactor.Add(source.fd(), EPOLLIN, {Tag::kPipe});
  reactor.Wait(HostNs(0));
  EXPECT_DEATH(reactor.Handle({}), "!is_handling_ does not hold");
}

}  // namespace
}  // namespace tcs
