#include "coordinator/tasks/reactor.h"

#include <sys/epoll.h>

#include <utility>

#include "coordinator/port/waits.h"
#include "shm/check.h"

namespace tcs {

namespace {

constexpr std::uint64_t Packed(const Subject& subject) {
  return (static_cast<std::uint64_t>(subject.tag) << 56) |
         (std::uint64_t{subject.number & Subject::kNumberMask} << 32) | subject.index;
}

constexpr Subject Unpacked(std::uint64_t data) {
  return {static_cast<Tag>(data >> 56), static_cast<std::uint32_t>(data),
          static_cast<std::uint32_t>(data >> 32) & Subject::kNumberMask};
}

}  // namespace

PollOutcome& PollOutcome::operator|=(const PollOutcome& other) {
  stops_running |= other.stops_running;
  wakes_others |= other.wakes_others;
  blocks_running |= other.blocks_running;
  looks_again |= other.looks_again;
  return *this;
}

Reactor::Reactor() : epoll_(MakeWaitSet()) {}

void Reactor::On(Tag tag, Handler handler) {
  handlers_[static_cast<std::size_t>(tag)] = std::move(handler);
}

bool Reactor::Add(int fd, std::uint32_t events, const Subject& subject) {
  epoll_event event{};
  event.events = events;
  event.data.u64 = Packed(subject);
  return ChangeWaitSet(epoll_.get(), EPOLL_CTL_ADD, fd, &event);
}

bool Reactor::Modify(int fd, std::uint32_t events, const Subject& subject) {
  epoll_event event{};
  event.events = events;
  event.data.u64 = Packed(subject);
  return ChangeWaitSet(epoll_.get(), EPOLL_CTL_MOD, fd, &event);
}

void Reactor::Remove(int fd) { ChangeWaitSet(epoll_.get(), EPOLL_CTL_DEL, fd, nullptr); }

std::size_t Reactor::Wait(HostDuration timeout) {
  TCS_CHECK(!is_handling_);
  epoll_event events[kAtOnce];
  count_ = WaitForEvents(epoll_.get(), events, timeout);
  for (std::size_t i = 0; i < count_; ++i) {
    queue_[i] = {Unpacked(events[i].data.u64), events[i].events};
  }
  is_full_ = count_ == kAtOnce;
  if (!is_full_) ++next_look_;
  return count_;
}

bool Reactor::HasMore() const { return IsReadable(epoll_.get()); }

PollOutcome Reactor::Handle(EventTime when) {
  PollOutcome found;
  TCS_CHECK(!is_handling_);
  is_handling_ = true;
  for (std::size_t i = 0; i < count_; ++i) {
    const Queued& one = queue_[i];
    const Handler& handler = handlers_[static_cast<std::size_t>(one.subject.tag)];
    TCS_CHECK(handler);
    found |= handler(one.subject, one.events, when);
  }
  count_ = 0;
  is_handling_ = false;
  return found;
}

}  // namespace tcs
