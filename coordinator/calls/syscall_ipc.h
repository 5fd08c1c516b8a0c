// System V semaphores and message queues, POSIX message queues, and sigtimedwait, called raw. A
// System V call without a deadline waits in the kernel, which keeps the order; the other calls wait
// here.
//
// For the coordinator's thread only.
#pragma once

#include "coordinator/calls/descriptor_waits.h"
#include "coordinator/calls/kernel_object_waits.h"
#include "coordinator/port/traps.h"
#include "coordinator/tasks/activations.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class SyscallIpc {
 public:
  SyscallIpc(RunState& run, Waker& waker, Activations& activations, KernelObjectWaits& objects,
             DescriptorWaits& descriptors)
      : run_(run),
        waker_(waker),
        activations_(activations),
        objects_(objects),
        descriptors_(descriptors) {}

  // semop, semtimedop, semctl, msgsnd, msgrcv, msgctl.
  void OfSystemV(Task& task, const TrappedCall& call);
  // mq_timedsend, mq_timedreceive.
  void Queue(Task& task, const TrappedCall& call);
  // rt_sigtimedwait.
  void AcceptSignal(Task& task, const TrappedCall& call);

  // The result of a call whose deadline has come.
  static std::int64_t ResultAtDeadline(const TrappedCall& call);
  // The object that a System V call is about.
  static KernelObject ObjectOf(const TrappedCall& call);

 private:
  // The deadline that the call's timeout says; false if the kernel has to judge the timeout.
  bool DeadlineAfter(const Task& task, std::uint64_t address, VirtualTime* deadline) const;
  bool DeadlineAt(const Task& task, std::uint64_t address, VirtualTime* deadline) const;

  RunState& run_;
  Waker& waker_;
  Activations& activations_;
  KernelObjectWaits& objects_;
  DescriptorWaits& descriptors_;
};

}  // namespace tcs
