// The kernel hands certain system calls of clients to the coordinator instead of carrying them out:
// a seccomp filter with user notification, inherited by whatever a client starts. The thread sleeps
// in the kernel until it is answered, and no handler runs in it.
#pragma once

#include <sys/types.h>

#include <vector>

#include "coordinator/port/traps.h"

namespace tcs {

// What is trapped in some runs only.
struct TrappedToo {
  bool executions = false;  // of other programs, the shim's, too; always where there are no levels
  bool draws = false;       // of random numbers
};

// Installs the filter in the calling process, which must be about to exec. It traps all futex
// calls, and what else reads time, sleeps, waits or speaks of the scheduler (trap.cc has the list),
// unless the shim made the call (shm::kOwnCallMark); and it keeps the program from the `guarded`
// processes (protection.h). The descriptor at which the calls arrive; -1: errno is set.
int InstallTrap(const std::vector<pid_t>& guarded, TrappedToo too = {});

// 0, or the errno of an attempt to install it in a child of its own, for a filter stays for ever.
int WhyNoTrap();

// A signal can be kept from a thread in a trapped call until that is answered (Linux 5.19). Where
// it cannot, a handler runs while the call waits, and the thread makes the call again.
bool TrapsHoldSignals();

// It executes another program. Trapped only where threads may be sent a signal by the coordinator,
// which the other program would have no handler for.
bool IsExecution(const TrappedCall& call);

// A program that was executed sets up its first thread, as each does, before it computes anything.
bool BeginsProgram(const TrappedCall& call);

// It sends a signal, to others or to itself.
bool SendsSignal(const TrappedCall& call);

// It ends its process, by the shim's doing, too.
bool IsEnd(const TrappedCall& call);

// It makes a thread or a process (clone_call.h).
bool MakesTask(const TrappedCall& call);

}  // namespace tcs
