#include "coordinator/calls/shared_events.h"

#include <poll.h>
#include <sys/epoll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <unordered_map>
#include <utility>
#include <vector>

#include "coordinator/calls/descriptor_waits.h"
#include "coordinator/os/open_files.h"
#include "coordinator/queues/one_waiter.h"
#include "coordinator/tasks/remote_descriptor.h"

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

// The only descriptor of a thread that waits to take.
int DescriptorOf(const Task& task) {
  return task.Awaits<awaited::Descriptors>()->fds.front().get();
}

bool HasEvent(const Task& task) {
  return IsReady(DescriptorOf(task), task.Awaits<awaited::Descriptors>()->events);
}

bool IsExclusive(const EpollEntry& entry) { return (entry.events & EPOLLEXCLUSIVE) != 0; }

// The file of the only descriptor: two threads that wait at the same file may be offered the same
// event. All epoll sets count as one file.
std::uint64_t PlaceOf(const Task& task) {
  struct stat status {};
  fstat(DescriptorOf(task), &status);
  return static_cast<std::uint64_t>(status.st_ino) ^ static_cast<std::uint64_t>(status.st_dev)
                                                         << 32;
}

// The entries of the epoll sets that threads wait at, each set looked at once: there may be
// hundreds.
class Looks {
 public:
  const std::vector<EpollEntry>& EntriesOf(const Task& task) {
    const auto [found, is_new] = entries_.try_emplace(task.order);
    if (is_new) found->second = tcs::EntriesOf(DescriptorOf(task));
    return found->second;
  }

 private:
  std::unordered_map<int, std::vector<EpollEntry>> entries_;
};

// Whether all that `other`'s set has to offer is a descriptor that both sets hold exclusively.
bool OffersTheSameOnly(const Task& first, const Task& other, Looks& looks) {
  const int set = DescriptorOf(first), other_set = DescriptorOf(other);
  std::vector<EpollEntry> exclusive = looks.EntriesOf(first);
  std::erase_if(exclusive, [](const EpollEntry& entry) { return !IsExclusive(entry); });
  if (exclusive.empty()) return false;
  bool shared = false;
  for (const EpollEntry& entry : looks.EntriesOf(other)) {
    const RemoteDescriptor target(other, entry.fd);
    // A file that is no longer under its number cannot be looked at.
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

bool SharedEvents::Wake(const std::vector<Task*>& awaiters, EventTime when) {
  std::vector<EventWaiter> waiters;
  for (const Task* task : awaiters) {
    waiters.push_back(WaiterOf(*task));
    if (awaiters.size() > 1 && waiters.back().takes) waiters.back().place = PlaceOf(*task);
  }
  Looks looks;
  const std::vector<EventShare> shares =
      ShareEvents(std::move(waiters), [this, &looks](int first, int second) {
        const Task &one = run_.table.At(first), &other = run_.table.At(second);
        return IsSameFile(DescriptorOf(one), DescriptorOf(other)) ||
               OffersTheSameOnly(one, other, looks);
      });
  bool passes_over = false;
  for (const EventShare& share : shares) {
    if (share.passed_over_for == kNoThread) continue;
    passes_over = true;
    PassOver(run_.table.At(share.thread), run_.table.At(share.passed_over_for));
  }
  for (const EventShare& share : shares) {
    Task& task = run_.table.At(share.thread);
    const bool is_woken = share.passed_over_for == kNoThread && task.wait.has_value();
    if (is_woken) waker_.Wake(task, shm::WakeReason::kGo, when);
  }
  return passes_over;
}

void SharedEvents::PassOver(Task& task, Task& first) {
  awaited::Descriptors& wait = *task.Awaits<awaited::Descriptors>();
  const int fd = DescriptorOf(task);
  if (IsSameFile(DescriptorOf(first), fd)) {
    wait.passed_over_for = first.order;
    first.passes_on = true;
    first.reply[1] = 1;
    // No notification tells of a call that the kernel carries out for the first thread.
    if (first.trap_id != 0 && first.after_call == AfterCall::kNone) {
      first.after_call = AfterCall::kTaken;
    }
  }
  // An event that is there already comes once more, in the next look, and is not for this thread.
  wait.skips_in = HasEvent(task) ? reactor_.next_look() : 0;
  reactor_.Modify(fd, wait.events | EPOLLET, DescriptorWaits::SubjectOf(task, wait));
  wait.is_edge_armed = true;
}

void SharedEvents::PassOn(Task& first, EventTime when) {
  if (!std::exchange(first.passes_on, false)) return;
  std::vector<EventWaiter> passed_over;
  for (Task& task : run_.table.tasks()) {
    auto* wait = task.Awaits<awaited::Descriptors>();
    if (wait == nullptr || wait->passed_over_for != first.order) continue;
    wait->passed_over_for = awaited::kNobody;
    passed_over.push_back(WaiterOf(task));
  }
  const Rest rest = PassRestOn(std::move(passed_over),
                               [this](int thread) { return HasEvent(run_.table.At(thread)); });
  if (rest.next == kNoThread) return;
  for (const int thread : rest.behind) {
    run_.table.At(thread).Awaits<awaited::Descriptors>()->passed_over_for = rest.next;
  }
  Task& next = run_.table.At(rest.next);
  waker_.Wake(next, shm::WakeReason::kGo, when);
  next.passes_on = !rest.behind.empty();
  next.reply[1] = next.passes_on ? 1 : 0;
}

}  // namespace tcs
