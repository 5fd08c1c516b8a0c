#include "coordinator/calls/descriptor_waits.h"

#include <sys/epoll.h>

#include <utility>

#include "coordinator/os/open_files.h"
#include "coordinator/tasks/borrowed.h"

namespace tcs {

awaited::Descriptors DescriptorWaits::Watch(const Task& task, const shm::WaitFd* fds,
                                            std::size_t count) {
  awaited::Descriptors watched{.number = ++wait_counter_, .order = task.fds_order};
  const Subject subject = SubjectOf(task, watched);
  for (std::size_t i = 0; i < count; ++i) {
    UniqueFd fd = CopyOfDescriptor(*task.process, fds[i].fd);
    if (!fd) continue;
    const std::uint32_t events = fds[i].events | EPOLLONESHOT;
    if (!reactor_.Modify(fd.get(), events, subject)) {
      if (!reactor_.Add(fd.get(), events, subject)) continue;
      // Terminals are never left in the set, so they always come this way.
      watched.has_terminal |= IsTerminal(fd.get());
    }
    watched.fds.push_back(std::move(fd));
  }
  return watched;
}

void DescriptorWaits::GoBehind(Task& task, awaited::Descriptors& watched) {
  watched.order = task.fds_order = ++fds_order_counter_;
}

awaited::Descriptors DescriptorWaits::WatchAsAsked(Task& task, const shm::Notification& note) {
  awaited::Descriptors watched = Watch(task, note.fds, note.fd_count);
  watched.signals = static_cast<std::uint64_t>(note.args[1]);
  watched.takes =
      note.args[0] != 0 && watched.fds.size() == 1 && note.fd_count == 1 && watched.signals == 0;
  watched.last_is_first = note.args[0] == 2;
  if (watched.takes) watched.events = note.fds[0].events;
  if (note.args[2] == 0) GoBehind(task, watched);
  return watched;
}

// The client shares the open file, so closing our descriptor leaves it in the epoll set until the
// client closes it, too. That is what we want: the next wait for it, under the same number of ours,
// only has to arm it again. What fires meanwhile is of a wait that is over (Tag::kAwaited). But a
// client's epoll set with a signalfd in it must not be polled by us when its wait is over: we have
// other signals, and it would forget that there is one.
void DescriptorWaits::Leave(const awaited::Descriptors& watched) {
  const bool forgets = watched.has_terminal || watched.signals != 0 || watched.is_edge_armed;
  if (!forgets) return;
  for (const UniqueFd& fd : watched.fds) reactor_.Remove(fd.get());
}

Subject DescriptorWaits::SubjectOf(const Task& task, const awaited::Descriptors& watched) {
  return {Tag::kAwaited, static_cast<std::uint32_t>(task.order),
          watched.number & Subject::kNumberMask};
}

}  // namespace tcs
