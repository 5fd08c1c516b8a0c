// The facts that are known of a signal that a client has sent: they tell whom the signal can
// concern.
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
  pid_t tid = 0;              // the process's thread; 0: the process
  int number = 0;             // 0: not known
  bool is_to_itself = false;  // to the sender itself: its handler, if there is one, has run

  // Whether the signal may stop a process, or let a process go on.
  bool MayStop() const;
};

// From what the sender says (kSignalled), and from its call, which may be another one than to send
// a signal.
SentSignal SentBy(RunState& run, const Task& task, const shm::Notification& note);
SentSignal SentBy(RunState& run, const Task& task, const TrappedCall& call);
// Whether a call that sends a signal sends signal 0, and so only asks whether the receiver is
// there.
bool OnlyAsks(const TrappedCall& call);

}  // namespace tcs
