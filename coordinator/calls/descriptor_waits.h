// The descriptors that threads wait for, as the coordinator has them in its epoll set: copies of
// the clients' own.
//
// For the coordinator's thread only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "coordinator/calls/outside_waits.h"
#include "coordinator/port/unique_fd.h"
#include "coordinator/tasks/reactor.h"
#include "coordinator/tasks/task.h"
#include "coordinator/tasks/wait.h"
#include "shm/layout.h"

namespace tcs {

class DescriptorWaits {
 public:
  DescriptorWaits(Reactor& reactor, OutsideWaits& outside) : reactor_(reactor), outside_(outside) {}

  // From now on the descriptors of the thread's process with these numbers are watched. A
  // descriptor that cannot be watched is left out: a file is always ready, and a closed descriptor
  // reports nothing.
  awaited::Descriptors Watch(const Task& task, const shm::WaitFd* fds, std::size_t count);
  // The same with copies of the descriptors that have been made already.
  struct Copy {
    shm::WaitFd asked;
    UniqueFd fd;
  };
  awaited::Descriptors Watch(const Task& task, std::vector<Copy> copies);
  // Watches once more the files that were kept for the thread. There must be such files.
  awaited::Descriptors WatchKept(Task& task);
  // Watches as the notification asks: whether one event is for one waiter, and whether signals end
  // the wait.
  awaited::Descriptors WatchAsAsked(Task& task, const shm::Notification& note);
  // The wait is a new one, behind all others that want to take from the same descriptor.
  void GoBehind(Task& task, awaited::Descriptors& watched);
  // A request was sent by a file that waiting threads may wait for: what comes by the file is
  // hidden from then on.
  void BeginAllAgain(TaskTable& table);
  // Events that were hidden from the waiting thread may be hidden no more (outside_waits.h).
  void LookAgain(Task& task);
  // The wait is over.
  void Leave(const awaited::Descriptors& watched);

  // The subject by which the reactor tells of the wait's events.
  static Subject SubjectOf(const Task& task, const awaited::Descriptors& watched);

 private:
  void BeginAgain(Task& task);
  void Add(const Task& task, Copy copy, const Subject& subject, awaited::Descriptors& watched);
  void AddMembers(const Task& task, int set, const Subject& subject, awaited::Descriptors& watched);
  // False if the descriptor cannot be watched.
  bool Arm(int fd, std::uint32_t events, const Subject& subject, awaited::Descriptors& watched);

  Reactor& reactor_;
  OutsideWaits& outside_;
  std::uint32_t wait_counter_ = 0;
  std::uint64_t fds_order_counter_ = 0;
};

}  // namespace tcs
