// What is known of a signal that a client has sent: from that it follows whom it can concern.
//
// For the coordinator's thread only.
#pragma once

#include <sys/types.h>

#include "coordinator/port/traps.h"
#include "coordinator/tasks/run_state.h"
#include "shm/layout.h"

namespace tcs {

struct SentSignal {
  pid_t pid = 0;              // the process that it was sent to; 0: any
  pid_t tid = 0;              // its thread; 0: the process
  int number = 0;             // 0: not known
  bool is_to_itself = false;  // its sender is that thread: where it has a handler, that has run

  // Whether it may stop a process, or let it go on.
  bool MayStop() const;
};

// By what the sender says (kSignalled), and by its call, which may be another one than to send a
// signal.
SentSignal SentBy(RunState& run, const Task& task, const shm::Notification& note);
SentSignal SentBy(RunState& run, const Task& task, const TrappedCall& call);
// Of a call that sends a signal: signal 0, by which it only asks whether the receiver is there.
bool OnlyAsks(const TrappedCall& call);

}  // namespace tcs
