// The kernel hands certain system calls of clients to the coordinator instead of carrying them out:
// a seccomp filter with user notification, inherited by all processes that a client starts. The
// calling thread sleeps in the kernel until the call is answered, and no handler runs in the
// thread.
#pragma once

#include <sys/types.h>

#include <vector>

#include "coordinator/port/traps.h"

namespace tcs {

// Calls that are trapped in some runs only.
struct TrappedToo {
  bool executions = false;  // of other programs, the shim's, too; always where there are no levels
  bool draws = false;       // of random numbers
};

// Installs the filter in the calling process, which must be about to exec. The filter traps all
// futex calls, and all others that read time, sleep, wait or speak of the scheduler (trap.cc has
// the list), unless the shim made the call (shm::kOwnCallMark). The filter also keeps the program
// from the `guarded` processes (protection.h). Returns the descriptor at which the calls arrive;
// -1: errno is set.
int InstallTrap(const std::vector<pid_t>& guarded, TrappedToo too = {});

// 0, or the errno of an attempt to install the filter in a child of its own, for a filter stays for
// ever.
int WhyNoTrap();

// Whether a signal can be kept from a thread in a trapped call until the call is answered (Linux
// 5.19). Where it cannot, a handler runs while the call waits, and the thread makes the call again.
bool TrapsHoldSignals();

// The call executes another program. Such a call is trapped only where threads may be sent a signal
// by the coordinator, which the other program would have no handler for.
bool IsExecution(const TrappedCall& call);

// By the call a program that was executed sets up its first thread, as every program does before it
// computes anything.
bool BeginsProgram(const TrappedCall& call);

// The call sends a signal, to others or to the caller.
bool SendsSignal(const TrappedCall& call);

// The call ends its process. That is so for the shim's own call, too.
bool IsEnd(const TrappedCall& call);

// The call makes a thread or a process (clone_call.h).
bool MakesTask(const TrappedCall& call);

}  // namespace tcs
