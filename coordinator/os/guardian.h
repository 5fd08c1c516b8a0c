// A process around the coordinator that ends whatever it leaves behind.
//
// Clients die with the coordinator (PDEATHSIG), but a client's own children do not, and one of
// those may spin at real-time priority. So tcsim is two processes: the guardian, which the user
// started, and the coordinator, its child. Both are subreapers: orphans come to the coordinator
// while it lives, then to the guardian. Neither outlives the other: the guardian's end is a SIGTERM
// to the coordinator, the coordinator's end makes the guardian kill and reap all that is left.
#pragma once

#include <functional>

namespace tcs {

struct GuardLimits {
  unsigned look_every_s = 30;
  unsigned stop_within_s = 10;
};

// Runs `coordinate` in a child process and returns its exit status once nothing that descends from
// it lives any more. Dies of the signal that the child died of. SIGTERM, SIGHUP and a
// SIGINT that somebody has sent are passed on, ^C and ^\ reach the child by the terminal, a stop
// stops both. Call it before there are threads.
//
// The child runs at real-time priority, so it must not go astray: it is killed, with a sentence on
// stderr, if it has computed all the time between two looks without a single Beat, and if it has
// not ended some time after a SIGTERM or SIGHUP.
int RunGuarded(const std::function<int()>& coordinate, GuardLimits limits = {});

// Says from inside `coordinate` that it gets on. Costs nothing; does nothing outside.
void Beat();

// Kills and reaps the children of this process, and the orphans that come to it, until none is
// left; gives up after two seconds (a process in the disk's hands does not die).
void KillDescendants();

}  // namespace tcs
