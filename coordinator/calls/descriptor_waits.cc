#include "coordinator/calls/descriptor_waits.h"

#include <poll.h>
#include <sys/epoll.h>

#include <utility>

#include "coordinator/os/open_files.h"
#include "coordinator/tasks/remote_descriptor.h"

namespace tcs {

namespace {

bool IsReady(int fd, std::uint32_t events) {
  pollfd probe{fd, static_cast<short>(events), 0};
  return poll(&probe, 1, 0) > 0;
}

// The events that are seen of a file of which something is hidden.
std::uint32_t SeenOf(OutsideWaits::Hidden hidden) {
  return hidden == OutsideWaits::Hidden::kAll ? 0 : std::uint32_t{EPOLLOUT};
}

}  // namespace

bool DescriptorWaits::Arm(int fd, std::uint32_t events, const Subject& subject,
                          awaited::Descriptors& watched) {
  if (reactor_.Modify(fd, events, subject)) return true;
  if (!reactor_.Add(fd, events, subject)) return false;
  // Terminals are never left in the set, so they always come this way.
  watched.has_terminal |= IsTerminal(fd);
  return true;
}

void DescriptorWaits::Add(const Task& task, Copy copy, const Subject& subject,
                          awaited::Descriptors& watched) {
  if (!copy.fd) return;
  const bool is_waited_for = copy.asked.events != 0;  // or is kept for the call only
  std::uint32_t events = copy.asked.events;
  const OutsideWaits::Hidden hidden = outside_.BeginsWait(task, copy.fd.get(), events);
  if (hidden != OutsideWaits::Hidden::kNothing) {
    watched.has_hidden = true;
    events &= SeenOf(hidden);
    AddMembers(task, copy.fd.get(), subject, watched);
  }
  const bool is_armed = is_waited_for && events != 0;
  if (is_armed && !Arm(copy.fd.get(), events | EPOLLONESHOT, subject, watched)) return;
  watched.fds.push_back(std::move(copy.fd));
  watched.asked.push_back(copy.asked);
}

// The set itself would tell of hidden events, too. If another member tells of an event once only,
// and the event is there already, the thread has been told of it.
void DescriptorWaits::AddMembers(const Task& task, int set, const Subject& subject,
                                 awaited::Descriptors& watched) {
  constexpr std::uint32_t kAsked = EPOLLIN | EPOLLOUT | EPOLLPRI | EPOLLRDHUP | EPOLLRDNORM;
  for (const EpollEntry& entry : EntriesOf(set)) {
    UniqueFd member = CopyOfDescriptor(*task.process, entry.fd);
    const std::uint32_t events = entry.events & kAsked;
    if (!member || events == 0 || outside_.IsHidden(member.get(), task.reached)) continue;
    // A member that tells of its event each time does so once more in the next look.
    const bool tells_once = (entry.events & EPOLLET) != 0;
    if (!Arm(member.get(), events | (tells_once ? std::uint32_t{EPOLLET} : 0U), subject, watched))
      continue;
    if (tells_once && IsReady(member.get(), events)) watched.skips_in = reactor_.next_look();
    watched.members.push_back(std::move(member));
  }
}

awaited::Descriptors DescriptorWaits::Watch(const Task& task, const shm::WaitFd* fds,
                                            std::size_t count) {
  awaited::Descriptors watched{
      .since = task.process->changes, .number = ++wait_counter_, .order = task.fds_order};
  const Subject subject = SubjectOf(task, watched);
  for (std::size_t i = 0; i < count; ++i) {
    Add(task, {fds[i], CopyOfDescriptor(*task.process, fds[i].fd)}, subject, watched);
  }
  return watched;
}

awaited::Descriptors DescriptorWaits::Watch(const Task& task, std::vector<Copy> copies) {
  awaited::Descriptors watched{
      .since = task.process->changes, .number = ++wait_counter_, .order = task.fds_order};
  const Subject subject = SubjectOf(task, watched);
  for (Copy& copy : copies) Add(task, std::move(copy), subject, watched);
  return watched;
}

// A thread that polls has looked for the files by their numbers, and found nothing. An event that
// is there already in a file no longer under its number is no news to the thread, as in the kernel.
awaited::Descriptors DescriptorWaits::WatchKept(Task& task) {
  KeptFiles kept = std::move(*std::exchange(task.kept, std::nullopt));
  awaited::Descriptors watched{.fds = std::move(kept.files),
                               .asked = std::move(kept.asked),
                               .keep = kept.keep,
                               .since = kept.since,
                               .number = ++wait_counter_,
                               .signals = kept.signals,
                               .done = kept.done,
                               .order = task.fds_order};
  const Subject subject = SubjectOf(task, watched);
  for (std::size_t i = 0; i < watched.fds.size(); ++i) {
    const std::uint32_t events = watched.asked[i].events;
    if (events == 0) continue;
    const int fd = watched.fds[i].get();
    const bool awaits_news = kept.keep == shm::KeepFiles::kForPoll && kept.are_replaced[i];
    Arm(fd, events | (awaits_news ? EPOLLET : EPOLLONESHOT), subject, watched);
    watched.is_edge_armed |= awaits_news;
    if (awaits_news && IsReady(fd, events)) watched.skips_in = reactor_.next_look();
  }
  return watched;
}

void DescriptorWaits::BeginAllAgain(TaskTable& table) {
  for (Task& task : table.tasks()) BeginAgain(task);
}

void DescriptorWaits::BeginAgain(Task& task) {
  auto* watched = task.Awaits<awaited::Descriptors>();
  if (watched == nullptr) return;
  const Subject subject = SubjectOf(task, *watched);
  for (std::size_t i = 0; i < watched->fds.size(); ++i) {
    const int fd = watched->fds[i].get();
    const std::uint32_t asked = watched->asked[i].events;
    const OutsideWaits::Hidden hidden = outside_.BeginsWait(task, fd, asked);
    if (hidden == OutsideWaits::Hidden::kNothing) continue;
    watched->has_hidden = true;
    reactor_.Modify(fd, (asked & SeenOf(hidden)) | EPOLLONESHOT, subject);
    if (watched->members.empty()) AddMembers(task, fd, subject, *watched);
  }
}

void DescriptorWaits::LookAgain(Task& task) {
  auto* watched = task.Awaits<awaited::Descriptors>();
  if (watched == nullptr || !watched->has_hidden) return;
  const Subject subject = SubjectOf(task, *watched);
  watched->has_hidden = false;
  for (std::size_t i = 0; i < watched->fds.size(); ++i) {
    const int fd = watched->fds[i].get();
    const bool is_hidden = outside_.Hides(task, fd);
    watched->has_hidden |= is_hidden;
    if (watched->asked[i].events == 0 || is_hidden) continue;
    Arm(fd, watched->asked[i].events | EPOLLONESHOT, subject, *watched);
  }
}

void DescriptorWaits::GoBehind(Task& task, awaited::Descriptors& watched) {
  watched.order = task.fds_order = ++fds_order_counter_;
}

awaited::Descriptors DescriptorWaits::WatchAsAsked(Task& task, const shm::Notification& note) {
  const auto keep = static_cast<shm::KeepFiles>(note.args[3]);
  awaited::Descriptors watched;
  if (keep == shm::KeepFiles::kAgain && task.kept.has_value()) {
    watched = WatchKept(task);
  } else {
    watched = Watch(task, note.fds, note.fd_count);
    watched.signals = static_cast<std::uint64_t>(note.args[1]);
    watched.keep = keep;
  }
  watched.takes = note.args[0] != 0 && watched.fds.size() == 1 && watched.signals == 0;
  watched.last_is_first = note.args[0] == 2;
  if (watched.takes) watched.events = watched.asked[0].events;
  if (note.args[2] == 0) GoBehind(task, watched);
  return watched;
}

// The client shares the open file, so closing our descriptor leaves the file in the epoll set until
// the client closes it, too. We want this: the next wait for the file, under the same number of
// ours, only has to arm it again. An event that fires meanwhile is of a wait that is over
// (Tag::kAwaited). But a client's epoll set with a signalfd in it must not be polled by us when its
// wait is over: we have other signals, and the set would forget that there is one.
void DescriptorWaits::Leave(const awaited::Descriptors& watched) {
  for (const UniqueFd& fd : watched.members) reactor_.Remove(fd.get());
  const bool forgets = watched.has_terminal || watched.signals != 0 || watched.is_edge_armed;
  if (!forgets) return;
  for (const UniqueFd& fd : watched.fds) reactor_.Remove(fd.get());
}

Subject DescriptorWaits::SubjectOf(const Task& task, const awaited::Descriptors& watched) {
  return {Tag::kAwaited, static_cast<std::uint32_t>(task.order),
          watched.number & Subject::kNumberMask};
}

}  // namespace tcs
