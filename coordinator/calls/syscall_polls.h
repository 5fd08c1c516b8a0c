// poll, select, epoll_wait and their kin, made raw: the thread waits here for what the call waits
// for; then the kernel carries the call out, and does not have to wait.
//
// For the coordinator's thread only.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "coordinator/calls/descriptor_waits.h"
#include "coordinator/port/traps.h"
#include "coordinator/tasks/waker.h"
#include "shm/layout.h"

namespace tcs {

class SyscallPolls {
 public:
  SyscallPolls(Waker& waker, DescriptorWaits& descriptors)
      : waker_(waker), descriptors_(descriptors) {}

  // The result of the call where the kernel does not carry it out.
  std::int64_t Poll(Task& task, const TrappedCall& call);
  // The result of such a call that has waited, and whose numbers mean files other than `file` and
  // its like by now. As in the kernel, the call looks for files by their numbers each time; but for
  // an epoll set, which is its file.
  static std::int64_t Again(const Task& task, const TrappedCall& call, int file);
  // A wait for descriptors has timed out: no descriptor is ready.
  static void ClearResult(const Task& task, const TrappedCall& call);

 private:
  static bool TimeoutOf(Task& task, const TrappedCall& call, std::int64_t* ns);
  static std::optional<std::vector<shm::WaitFd>> FdsOf(const Task& task, const TrappedCall& call);
  static std::optional<std::uint64_t> MaskOf(const Task& task, const TrappedCall& call);
  static std::uint64_t SignalsOf(const Task& task, const TrappedCall& call);

  Waker& waker_;
  DescriptorWaits& descriptors_;
};

}  // namespace tcs
