// The signals of a thread, as its program knows them.
//
// For the coordinator's thread only.
#pragma once

#include "coordinator/port/proc_files.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

// Without the signal that the coordinator has sent to the thread (gate_keeper.h,
// undispatched_threads.h), which is nothing of its program's. A signal of the same number that the
// coordinator did not send is the C library's: every thread has to handle it, whatever it waits in.
// At its gate a thread blocks more than its program does, until it waits there.
SignalSets SignalsOf(const RunState& run, Task& task);
// The signals that the kernel drops when they are sent to a thread with these sets: signals that do
// nothing, and are not blocked.
std::uint64_t LostOf(const SignalSets& sets);

}  // namespace tcs
