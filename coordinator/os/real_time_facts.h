// Asks the kernel for SCHED_FIFO, by trying.
#pragma once

#include <optional>
#include <string>

#include "coordinator/os/real_time_right.h"

namespace tcs {

// Whether this process, whatever its priority is now, may have the levels of a run, and the other
// facts that tell why not. A child tries it, and ends at once, so that nothing is left to undo. The
// caller may have threads.
RealTimeFacts AskForRealTime();

// Where the files of a process's group of the cpu controller are. `groups`: the process's
// /proc/self/cgroup, `mounts`: the process's /proc/self/mountinfo. None: there is no such group, as
// under version 2, or it is mounted nowhere. Pure.
struct GroupPlace {
  std::string top;     // of all groups that are seen: where they are mounted
  std::string folder;  // of the process's own group: `top` or below
};
std::optional<GroupPlace> PlaceOfCpuGroup(const std::string& groups, const std::string& mounts);

}  // namespace tcs
