// Two processes around the coordinator, so that nothing outlives a run, whichever process is
// killed.
//
//   guardian     the process that the user started; waits for the keeper
//   └─ keeper      in a process group of its own, which a kill of the job's does not reach
//      └─ coordinator ── clients and all that they start
//
// Clients die with the coordinator (PDEATHSIG), but a client's own children do not, and one of
// those may spin at real-time priority. So all three processes are subreapers: orphans come to the
// coordinator while it lives, then to the keeper, then to the guardian, which kills and reaps them.
// None of the three processes outlives another one: the guardian's end is an orderly end of the
// run, the keeper's is the coordinator's at once, and the coordinator's end makes the keeper kill
// what is left.
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

namespace tcs {

struct GuardLimits {
  unsigned look_every_s = 30;
  unsigned stop_within_s = 10;
  unsigned say_within_s = 3;  // where the coordinator went astray
};

// Runs `coordinate` in a child process and returns the child's exit status once no descendant of
// the child lives any more. Dies of the signal that the child died of, after a sentence on stderr.
// SIGTERM, SIGHUP and a SIGINT that somebody has sent are passed on, ^C and ^\ reach the child by
// the terminal, ^Z stops it with the job. Call it before there are threads.
//
// The child runs at real-time priority, so the child must not go astray. The child is killed, with
// a sentence on stderr, if it has computed all the time between two looks without a single Beat, if
// a tracer holds it as long, and if it has not ended some time after a SIGTERM or SIGHUP. A child
// that is stopped without the guardian is made to go on, with a sentence, too.
int RunGuarded(const std::function<int()>& coordinate, GuardLimits limits = {});

// Says from inside `coordinate` which CPU the clients are bound to, so that none of them keeps its
// real-time priority when the coordinator is killed. Does nothing outside.
void ClientsRunOn(int cpu);

// Says from inside `coordinate` that the coordinator gets on. Costs nothing; does nothing outside.
void Beat();

// A note is a file that is to be written, whole, should `coordinate` end and not have taken its
// note back: the remains of a run that is killed. A note replaces the note before. The call only
// copies: a coordinator that wrote the file itself would wait for the disk, and its clients compute
// on meanwhile. A text that is too long for a note is none. Does nothing outside.
void LeaveNote(const std::string& path, const std::string& text);
void TakeNoteBack();

// A file, or a folder, that must not outlive the run: the keeper removes it if `coordinate` ends
// without RemoveNow. The keeper removes a few hundred of these; a killed run leaves the rest.
void RemoveIfKilled(const std::string& path);
void RemoveNow(const std::string& path);

// tcsim's own processes around and above this one, which its clients are not to touch.
std::vector<pid_t> GuardsOf(pid_t coordinator);

}  // namespace tcs
