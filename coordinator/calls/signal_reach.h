// Signals from one robot to another, which have to wait for turns of the receiver that have begun
// before their order (engine/turns_beside.h). As where a socket is reached for the first time
// (local_sockets.h), the wait takes at most one drift bound, once.
#pragma once

#include <sys/types.h>

#include "coordinator/tasks/run_state.h"

namespace tcs {

// The thread is about to send a signal to that process; 0 or less: to any. The robots that may get
// the signal, except the thread's own, have no turns before their order from now on. The thread
// comes to where the turns that have begun are over. True if there are such robots: the thread has
// to hold.
bool ReachBySignal(RunState& run, Task& task, pid_t receiver);

}  // namespace tcs
