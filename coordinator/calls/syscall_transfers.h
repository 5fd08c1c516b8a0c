// Trapped calls that transfer data, or connect: each call waits here until the kernel can carry it
// out, or would have refused it at once.
//
// For the coordinator's thread only.
#pragma once

#include "coordinator/calls/descriptor_waits.h"
#include "coordinator/calls/local_sockets.h"
#include "coordinator/calls/outside_waits.h"
#include "coordinator/calls/syscall_draws.h"
#include "coordinator/calls/syscall_timers.h"
#include "coordinator/port/traps.h"
#include "coordinator/tasks/activations.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class SyscallTransfers {
 public:
  SyscallTransfers(RunState& run, Waker& waker, Activations& activations,
                   DescriptorWaits& descriptors, SyscallTimers& timers, LocalSockets& local_sockets,
                   const SyscallDraws& draws, OutsideWaits& outside)
      : run_(run),
        waker_(waker),
        activations_(activations),
        descriptors_(descriptors),
        timers_(timers),
        local_sockets_(local_sockets),
        draws_(draws),
        outside_(outside) {}

  // The call goes on once it is ready, or can find all that was sent until now.
  void Handle(Task& task, const TrappedCall& call);
  static bool Receives(const TrappedCall& call);

 private:
  RunState& run_;
  Waker& waker_;
  Activations& activations_;
  DescriptorWaits& descriptors_;
  SyscallTimers& timers_;
  LocalSockets& local_sockets_;
  const SyscallDraws& draws_;
  OutsideWaits& outside_;
};

}  // namespace tcs
