// The threads that a killed coordinator leaves at real-time priority on its CPU.
#pragma once

namespace tcs {

// Takes real-time priority from every thread that has one of a run's levels (host.h) and is bound
// to that CPU alone, so whichever of them holds a lock of the kernel gets to release it. Finds them
// by asking for each thread number: until this has happened, no path may be looked up in /proc. The
// look-up could wait for one of those threads, and that one for ever for another that spins.
// `pid_max` is the kernel's, read before. Takes some 0.1 µs for each number.
void LowerStraysOn(int cpu, int pid_max);

// /proc/sys/kernel/pid_max.
int MostPids();

}  // namespace tcs
