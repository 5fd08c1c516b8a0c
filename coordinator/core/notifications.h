// What threads notify, each to where it belongs. Everything in a notification is untrusted: it is a
// copy, and it is checked.
//
// For the coordinator's thread only.
#pragma once

#include <cstdint>

#include "coordinator/core/dds_gateway.h"
#include "coordinator/core/descriptor_waits.h"
#include "coordinator/core/expulsion.h"
#include "coordinator/core/kernel_object_waits.h"
#include "coordinator/core/run_state.h"
#include "coordinator/core/scheduling_calls.h"
#include "coordinator/core/signal_calls.h"
#include "coordinator/core/slot_check.h"
#include "coordinator/core/spawns.h"
#include "coordinator/core/timer_calls.h"
#include "coordinator/core/unknown_children.h"
#include "coordinator/core/waker.h"
#include "shm/layout.h"

namespace tcs {

class Notifications {
 public:
  struct Parts {
    Expulsion& expulsion;
    DescriptorWaits& descriptors;
    UnknownChildren& unknown_children;
    TimerCalls& timers;
    Spawns& spawns;
    SchedulingCalls& scheduling;
    SignalCalls& signals;
    KernelObjectWaits& objects;
    DdsGateway& dds;
  };

  Notifications(RunState& run, Waker& waker, Parts parts)
      : run_(run), waker_(waker), parts_(parts) {}

  // True: there may be more by now that belongs to this moment.
  bool Handle(Task& task, const shm::Notification& note);
  // Equals have their turn. As Handle.
  bool Yield(Task& task);

 private:
  static std::int64_t WaitDeadlineOf(const Task& task, const shm::Notification& note);

  RunState& run_;
  Waker& waker_;
  Parts parts_;
};

}  // namespace tcs
