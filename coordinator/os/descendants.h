// The processes of a run: the descendants of this process.
//
// A subreaper (prctl) gets the orphans among its descendants, so that no process leaves the tree:
// neither by forking twice nor by a session of its own.
#pragma once

#include <sys/types.h>

#include <vector>

namespace tcs {

// All descendants of `root`, as they are at this moment.
std::vector<pid_t> DescendantsOf(pid_t root);

// Kills and reaps the descendants of this process, until none is left. Gives up after two seconds
// (a process in the disk's hands does not die), or a minute where a process that was killed has yet
// to get a processor, to die by.
void KillDescendants();

}  // namespace tcs
