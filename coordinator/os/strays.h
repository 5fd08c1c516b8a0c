// The threads that a run has at real-time priority on its CPU, whether anybody knows them or not.
#pragma once

#include <sys/types.h>

#include <vector>

namespace tcs {

// The threads that have one of a run's levels (port/levels.h) and are bound to that CPU alone. They
// are found by asking for each thread number, some 0.1 µs each; `pid_max` is the kernel's, read
// before. No path is looked up in /proc: while one of those threads spins, the look-up could wait
// for another one that is in the kernel and never gets on.
std::vector<pid_t> RealTimeThreadsOn(int cpu, int pid_max);

// After a coordinator was killed: takes real-time priority from all these threads, so that no
// thread spins there any more, and a thread that holds a lock of the kernel gets to release it.
void LowerStraysOn(int cpu, int pid_max);

// /proc/sys/kernel/pid_max.
int MostPids();

}  // namespace tcs
