// Hands each notification of a thread to the part that it belongs to. Everything in a notification
// is untrusted: the notification is a copy, and it is checked.
//
// For the coordinator's thread only.
#pragma once

#include <cstdint>

#include "coordinator/calls/date_calls.h"
#include "coordinator/calls/dds_gateway.h"
#include "coordinator/calls/descriptor_waits.h"
#include "coordinator/calls/kernel_object_waits.h"
#include "coordinator/calls/local_sockets.h"
#include "coordinator/calls/scheduling_calls.h"
#include "coordinator/calls/signal_calls.h"
#include "coordinator/calls/spawns.h"
#include "coordinator/calls/timer_calls.h"
#include "coordinator/processes/protocol_violations.h"
#include "coordinator/processes/slot_check.h"
#include "coordinator/processes/unregistered_children.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/spin_waits.h"
#include "coordinator/tasks/waker.h"
#include "shm/layout.h"

namespace tcs {

class Notifications {
 public:
  struct Parts {
    ProtocolViolations& violations;
    DescriptorWaits& descriptors;
    UnregisteredChildren& unregistered_children;
    TimerCalls& timers;
    Spawns& spawns;
    SchedulingCalls& scheduling;
    SignalCalls& signals;
    KernelObjectWaits& objects;
    DdsGateway& dds;
    LocalSockets& local_sockets;
    OutsideWaits& outside;
    SpinWaits& spins;
    DateCalls& dates;
  };

  Notifications(RunState& run, Waker& waker, Parts parts)
      : run_(run), waker_(waker), parts_(parts) {}

  // True: there may be more events by now that belong to this moment.
  bool Handle(Task& task, const shm::Notification& note);
  // Equal threads have their turn. Returns as Handle.
  bool Yield(Task& task);

 private:
  static VirtualTime WaitDeadlineOf(const Task& task, const shm::Notification& note);
  bool MeetsOutside(Task& task, const shm::Notification& note);
  pid_t ProcessNamed(const Task& by, std::int64_t said);

  RunState& run_;
  Waker& waker_;
  Parts parts_;
};

}  // namespace tcs
