// One event, one waiter (calls/one_waiter.h): which descriptors offer the same event, and what the
// kernel has there. So does the kernel with several threads that wait in epoll sets which hold the
// same descriptor with EPOLLEXCLUSIVE; what that keeps from the others is the first one's for good.
//
// A thread that has taken something says so, if others were passed over for it (kPassOn).
#include "coordinator/calls/one_waiter.h"

#include <poll.h>
#include <sys/epoll.h>
#include <unistd.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "coordinator/core/borrowed.h"
#include "coordinator/core/engine.h"
#include "coordinator/os/open_files.h"

namespace tcs {

namespace {

constexpr std::uint32_t kWhatPollKnows = EPOLLIN | EPOLLPRI | EPOLLOUT | EPOLLRDHUP;

bool IsReady(int fd, std::uint32_t events) {
  pollfd probe{fd, static_cast<short>(events & kWhatPollKnows), 0};
  return poll(&probe, 1, 0) > 0;
}

EventWaiter WaiterOf(const Task& task) {
  const awaited::Descriptors& wait = *task.Awaits<awaited::Descriptors>();
  return {task.order, wait.takes, wait.last_is_first, wait.order};
}

// The only descriptor of one that takes.
int DescriptorOf(const Task& task) {
  return task.Awaits<awaited::Descriptors>()->fds.front().get();
}

bool HasEvent(const Task& task) {
  return IsReady(DescriptorOf(task), task.Awaits<awaited::Descriptors>()->events);
}

bool IsExclusive(const EpollEntry& entry) { return (entry.events & EPOLLEXCLUSIVE) != 0; }

// Whether all that `other`'s set has to offer is a descriptor that both sets hold exclusively.
bool OffersTheSameOnly(const Task& first, const Task& other) {
  const int set = DescriptorOf(first), other_set = DescriptorOf(other);
  std::vector<EpollEntry> exclusive = EntriesOf(set);
  std::erase_if(exclusive, [](const EpollEntry& entry) { return !IsExclusive(entry); });
  if (exclusive.empty()) return false;
  bool shared = false;
  for (const EpollEntry& entry : EntriesOf(other_set)) {
    const Borrowed target(other, entry.fd);
    // What is no longer under its number cannot be looked at.
    if (target.fd() < 0 || !IsAbout(other_set, entry, target.fd())) continue;
    if (!IsReady(target.fd(), entry.events)) continue;
    const bool same = IsExclusive(entry) &&
                      std::any_of(exclusive.begin(), exclusive.end(), [&](const EpollEntry& mine) {
                        return IsAbout(set, mine, target.fd());
                      });
    if (!same) return false;
    shared = true;
  }
  return shared;
}

}  // namespace

// Those for whom an event has come, in one look at the kernel.
void Engine::WakeAwaiters(const std::vector<Task*>& awaiters, Moment moment) {
  std::vector<EventWaiter> waiters;
  for (const Task* task : awaiters) waiters.push_back(WaiterOf(*task));
  const std::vector<EventShare> shares =
      ShareEvents(std::move(waiters), [this](int first, int second) {
        const Task &one = TaskAt(first), &other = TaskAt(second);
        return IsSameFile(DescriptorOf(one), DescriptorOf(other)) || OffersTheSameOnly(one, other);
      });
  for (const EventShare& share : shares) {
    if (share.passed_over_for == kNoThread) continue;
    PassOver(TaskAt(share.thread), TaskAt(share.passed_over_for));
  }
  for (const EventShare& share : shares) {
    Task& task = TaskAt(share.thread);
    const bool is_woken = share.passed_over_for == kNoThread && task.wait.has_value();
    if (is_woken) MakeReady(task, shm::WakeReason::kGo, moment);
  }
}

void Engine::PassOver(Task& task, Task& first) {
  awaited::Descriptors& wait = *task.Awaits<awaited::Descriptors>();
  const int fd = DescriptorOf(task);
  if (IsSameFile(DescriptorOf(first), fd)) {
    wait.passed_over_for = first.order;
    first.passes_on = true;
    first.reply[1] = 1;
    // What the kernel carries out for it nobody tells of.
    if (first.trap_id != 0 && first.follow_up == FollowUp::kNone) {
      first.follow_up = FollowUp::kTaken;
    }
  }
  // What is there already comes once more, at once, and is not for it.
  wait.skips_event = HasEvent(task);
  reactor_.Modify(fd, wait.events | EPOLLET, SubjectOfWait(task, wait));
  wait.is_edge_armed = true;
}

// The thread has tried what it was woken for: what it has left is for the next.
void Engine::PassOn(Task& first, Moment moment) {
  if (!std::exchange(first.passes_on, false)) return;
  std::vector<EventWaiter> passed_over;
  for (Task& task : table_.tasks()) {
    auto* wait = task.Awaits<awaited::Descriptors>();
    if (wait == nullptr || wait->passed_over_for != first.order) continue;
    wait->passed_over_for = awaited::kNobody;
    passed_over.push_back(WaiterOf(task));
  }
  const Rest rest =
      PassRestOn(std::move(passed_over), [this](int thread) { return HasEvent(TaskAt(thread)); });
  if (rest.next == kNoThread) return;
  for (const int thread : rest.behind) {
    TaskAt(thread).Awaits<awaited::Descriptors>()->passed_over_for = rest.next;
  }
  Task& next = TaskAt(rest.next);
  MakeReady(next, shm::WakeReason::kGo, moment);
  next.passes_on = !rest.behind.empty();
  next.reply[1] = next.passes_on ? 1 : 0;
}

}  // namespace tcs
