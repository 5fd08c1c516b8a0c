#include "coordinator/os/descendants.h"

#include <dirent.h>
#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <map>

#include "coordinator/port/levels.h"
#include "coordinator/port/proc_files.h"

namespace tcs {

namespace {

constexpr int kKillTurns = 400, kMostKillTurns = 12'000;  // of 5 ms
constexpr useconds_t kKillTurnUs = 5'000;

// Kills all descendants at once, not only the children: a process that spins at real-time priority
// keeps its killed parent from the processor, and so from dying, for ever. This process is above
// them all meanwhile, where that is permitted: then no process forks faster than it is killed. True
// if a killed process waits for a processor.
bool KillTree() {
  SetLevel(0, Level::kKernelOnly);
  bool waits = false;
  for (const pid_t pid : DescendantsOf(getpid())) {
    kill(pid, SIGKILL);
    waits |= ThreadState(pid) == 'R';
  }
  LeaveRealTime(0);
  return waits;
}

}  // namespace

std::vector<pid_t> DescendantsOf(pid_t root) {
  std::vector<pid_t> found;
  DIR* proc = opendir("/proc");
  if (proc == nullptr) return found;
  std::multimap<pid_t, pid_t> children;
  while (const dirent* entry = readdir(proc)) {
    if (const int pid = atoi(entry->d_name); pid > 0) children.emplace(ParentOf(pid), pid);
  }
  closedir(proc);
  std::vector<pid_t> parents{root};
  while (!parents.empty()) {
    const auto [first, last] = children.equal_range(parents.back());
    parents.pop_back();
    for (auto child = first; child != last; ++child) {
      found.push_back(child->second);
      parents.push_back(child->second);
    }
  }
  return found;
}

void KillDescendants() {
  bool waits = false;
  for (int turn = 0; turn < (waits ? kMostKillTurns : kKillTurns); ++turn) {
    waits = KillTree();
    pid_t reaped;
    while ((reaped = waitpid(-1, nullptr, WNOHANG)) > 0) {
    }
    if (reaped < 0 && errno == ECHILD) return;
    usleep(kKillTurnUs);
  }
}

}  // namespace tcs
