// Which thread may ask the robot's scheduler for what: the kernel's rules (sched(7)), by the
// credentials and resource limits that the program has in the kernel. The kernel itself cannot
// check, because these calls never reach it. Anything else that keeps tcsim from real-time
// priorities on the host (a group without a budget, a filter) is the host's, and not the robot's.
#pragma once

#include <sys/types.h>

#include "coordinator/policy/scheduling_parameters.h"

namespace tcs {

// From now on a limit (RLIMIT_RTPRIO) of 0 allows every real-time priority: for runs of a user whom
// the host gives neither a limit nor the capability, which says nothing of the robot.
void IgnoreLackOfRealTimeLimit();

// Threads by their kernel numbers. True for a thread with CAP_SYS_NICE; only such a thread may have
// SCHED_DEADLINE.
bool MaySetScheduling(pid_t asking, pid_t tid, const SchedulingParameters& now,
                      const SchedulingParameters& wanted);
bool MaySetAffinity(pid_t asking, pid_t tid);

}  // namespace tcs
