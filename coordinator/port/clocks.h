// The host's clocks. The headers of this folder are together all that the engine asks of the
// machine it runs on (docs/INTERNALS.md, "The port"): a run is given the machine's port, a
// simulated run that of tests/simulate/.
//
// Nanoseconds, unless a name says otherwise. Each function may be called from any thread.
#pragma once

#include <sys/types.h>
#include <time.h>

#include <cstdint>

namespace tcs {

// The time-stamp counter of the processor that the caller runs on.
std::uint64_t HostTsc();

// Nanoseconds per TSC tick times 2^32, measured against CLOCK_MONOTONIC_RAW since the process was
// loaded, and for at least 10 ms: the function sleeps for what is missing.
std::uint64_t CalibrateTsc();

// A clock of the host, in nanoseconds.
std::int64_t HostClockNs(clockid_t id);

// CPU time of a process; -1 if it has ended.
std::int64_t ProcessCpuClockNs(pid_t pid);

// CPU time of one thread of any process: a descriptor to read it from, -1 if that cannot be had;
// and its value, -1 once the thread has ended.
int OpenThreadCpuClock(pid_t tid);
std::int64_t ReadThreadCpuClock(int fd);

}  // namespace tcs
