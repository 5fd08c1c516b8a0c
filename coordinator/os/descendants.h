// The processes of a run: those that descend from this one.
//
// Who is a subreaper (prctl) gets the orphans among them, so that nobody leaves the tree: neither
// by forking twice nor by a session of its own.
#pragma once

#include <sys/types.h>

#include <vector>

namespace tcs {

// All of them, as they are at this moment.
std::vector<pid_t> DescendantsOf(pid_t root);

// Kills and reaps what descends from this process, until nothing is left. Gives up after two
// seconds (a process in the disk's hands does not die), or a minute where one that was killed has
// yet to get a processor, to die by.
void KillDescendants();

}  // namespace tcs
