// Which thread may ask the robot's scheduler for what: the kernel's rules (sched(7)), by the
// credentials and resource limits that the program has in the kernel. The kernel itself cannot
// check, because these calls never reach it.
#pragma once

#include <sys/types.h>

#include "coordinator/policy/scheduling_parameters.h"

namespace tcs {

// On a robot its programs may have any real-time priority, whatever the limits of a user whom the
// host does not even let tcsim have one.
void IgnoreRealTimeLimits();

// Threads by their kernel numbers. True for a thread with CAP_SYS_NICE; only such a thread may have
// SCHED_DEADLINE.
bool MaySetScheduling(pid_t asking, pid_t tid, const SchedulingParameters& now,
                      const SchedulingParameters& wanted);
bool MaySetAffinity(pid_t asking, pid_t tid);

}  // namespace tcs
