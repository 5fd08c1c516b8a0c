// One event, one waiter. Of several threads that wait to take from the same descriptor (read,
// accept, the events of an epoll set) the kernel wakes one: the one that waits longest, of those in
// one epoll set the one that came last. So does it of several that wait in epoll sets which hold
// the same descriptor with EPOLLEXCLUSIVE. To the coordinator, which polls for each of them, such
// an event comes for all.
//
// The others are passed over: they wait on, for the next event. Should the first leave something,
// it is for the next of them: a thread that has taken something says so, if others were passed over
// for it (kPassOn). What EPOLLEXCLUSIVE keeps from the others is the first one's for good.
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

// In the order of waiting, or of waiters in an epoll set the other way round.
bool GoesBefore(const Task* one, const Task* other) {
  const auto place = [](const Task& task) {
    const auto order = static_cast<std::int64_t>(task.wait_order);
    return task.last_is_first ? -order : order;
  };
  return place(*one) < place(*other);
}

bool IsExclusive(const EpollEntry& entry) { return (entry.events & EPOLLEXCLUSIVE) != 0; }

// Whether all that `other`'s set has to offer is a descriptor that both sets hold exclusively.
bool OffersTheSameOnly(const Task& first, const Task& other) {
  const int set = first.watched.front(), other_set = other.watched.front();
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
void Engine::WakeAwaiters(std::vector<Task*> awaiters, Moment moment) {
  std::sort(awaiters.begin(), awaiters.end(), GoesBefore);
  std::vector<Task*> woken;
  for (Task* task : awaiters) {
    const bool takes = task->takes && task->watched.size() == 1;
    const auto first = std::find_if(woken.begin(), woken.end(), [&](const Task* one) {
      return takes && one->takes && one->watched.size() == 1 &&
             (IsSameFile(one->watched.front(), task->watched.front()) ||
              OffersTheSameOnly(*one, *task));
    });
    if (first == woken.end()) {
      woken.push_back(task);
    } else {
      PassOver(*task, **first);
    }
  }
  for (Task* task : woken) {
    if (task->state == TaskState::kWaiting) MakeReady(*task, shm::WakeReason::kGo, moment);
  }
}

void Engine::PassOver(Task& task, Task& first) {
  const int fd = task.watched.front();
  if (IsSameFile(first.watched.front(), fd)) {
    task.passed_over_for = &first;
    first.passes_on = true;
    first.reply[1] = 1;
    // What the kernel carries out for it nobody tells of.
    if (first.trap_id != 0 && first.follow_up == FollowUp::kNone) {
      first.follow_up = FollowUp::kTaken;
    }
  }
  // What is there already comes once more, at once, and is not for it.
  task.skips_event = IsReady(fd, task.watched_events);
  reactor_.Modify(fd, task.watched_events | EPOLLET, SubjectOfWait(task));
  task.is_edge_armed = true;
}

// The thread has tried what it was woken for: what it has left is for the next.
void Engine::PassOn(Task& first, Moment moment) {
  if (!std::exchange(first.passes_on, false)) return;
  std::vector<Task*> others;
  for (Task& task : tasks_) {
    if (task.passed_over_for == &first) others.push_back(&task);
  }
  if (others.empty()) return;
  std::sort(others.begin(), others.end(), GoesBefore);
  Task* next = nullptr;
  for (Task* task : others) {
    task->passed_over_for = next;
    if (next != nullptr || !IsReady(task->watched.front(), task->watched_events)) continue;
    next = task;
  }
  if (next == nullptr) return;
  MakeReady(*next, shm::WakeReason::kGo, moment);
  next->passes_on = next != others.back();
  next->reply[1] = next->passes_on ? 1 : 0;
}

}  // namespace tcs
