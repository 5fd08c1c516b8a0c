#include "coordinator/os/guardian.h"

#include <errno.h>
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <new>
#include <string>

#include "coordinator/os/cpu_claim.h"
#include "coordinator/os/end_signals.h"
#include "coordinator/os/files.h"
#include "coordinator/os/keeper.h"
#include "coordinator/os/say.h"
#include "coordinator/os/strays.h"
#include "coordinator/port/proc_files.h"

namespace tcs {

namespace {

GuardedState* g_state = nullptr;

void ShareState() {
  void* page =
      mmap(nullptr, sizeof *g_state, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  static GuardedState alone;  // the keeper would not see its beats
  g_state = page != MAP_FAILED ? new (page) GuardedState : &alone;
  g_state->pid_max = MostPids();
}

// Passes signals on to the keeper until it has ended. Returns how it has ended, as of waitpid.
int AwaitKeeper(pid_t keeper, const sigset_t& awaited) {
  for (;;) {
    siginfo_t info{};
    const int signal = sigwaitinfo(&awaited, &info);
    // ^C reaches the coordinator by itself; a signal that somebody has sent may have reached this
    // process only.
    const bool is_for_all = signal == SIGINT && info.si_code == SI_KERNEL;
    if (signal != SIGCHLD && signal > 0 && !is_for_all) kill(keeper, signal);
    int status = 0;
    while (waitpid(keeper, &status, WNOHANG | WUNTRACED) == keeper) {
      if (!WIFSTOPPED(status)) return status;
      kill(keeper, SIGCONT);  // the keeper is in nobody's job
    }
  }
}

std::string NameOf(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/comm");
  std::string name;
  std::getline(file, name);
  return name;
}

}  // namespace

void ClientsRunOn(int cpu) {
  if (g_state != nullptr) g_state->clients_cpu.store(cpu);
}

void Beat() {
  if (g_state != nullptr) g_state->beats.fetch_add(1, std::memory_order_relaxed);
}

void LeaveNote(const std::string& path, const std::string& text) {
  if (g_state == nullptr || path.size() >= Note::kMostPath || text.size() > Note::kMostText) return;
  const int which = g_state->note.load() == 0 ? 1 : 0;
  Note& note = g_state->notes[which];
  memcpy(note.path, path.c_str(), path.size() + 1);
  memcpy(note.text, text.data(), text.size());
  note.size = text.size();
  g_state->note.store(which);
}

void TakeNoteBack() {
  if (g_state != nullptr) g_state->note.store(-1);
}

void RemoveIfKilled(const std::string& path) {
  if (g_state == nullptr || path.size() >= Removal::kMostPath) return;
  for (Removal& removal : g_state->removals) {
    if (removal.is_set.load()) continue;
    memcpy(removal.path, path.c_str(), path.size() + 1);
    removal.is_set.store(true);
    return;
  }
}

// First the file: were this process killed between the two, the file would go, too.
void RemoveNow(const std::string& path) {
  RemoveAll(path);
  if (g_state == nullptr) return;
  for (Removal& removal : g_state->removals) {
    if (removal.is_set.load() && path == removal.path) removal.is_set.store(false);
  }
}

// By name: the program that a process executes may not be asked for where the process is not
// dumpable.
std::vector<pid_t> GuardsOf(pid_t coordinator) {
  std::vector<pid_t> guards;
  const std::string own = NameOf(coordinator);
  for (pid_t pid = ParentOf(coordinator); pid > 1 && NameOf(pid) == own; pid = ParentOf(pid)) {
    guards.push_back(pid);
  }
  return guards;
}

int RunGuarded(const std::function<int()>& coordinate, GuardLimits limits) {
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  ShareState();
  ShareClaimsOfChildren();
  sigset_t awaited = EndSignals(), before;
  sigaddset(&awaited, SIGCHLD);
  sigprocmask(SIG_BLOCK, &awaited, &before);
  const pid_t guardian = getpid(), keeper = fork();
  if (keeper == 0) {
    Keep(guardian, limits, g_state, [&] {
      sigprocmask(SIG_SETMASK, &before, nullptr);
      return coordinate();
    });
  }
  if (keeper < 0) {
    sigprocmask(SIG_SETMASK, &before, nullptr);
    Say(std::string("no process can be made: ") + strerror(errno) +
        "; end some, or raise `ulimit -u`");
    return 2;
  }
  prctl(PR_SET_DUMPABLE, 0);
  signal(SIGQUIT, SIG_IGN);
  const int status = AwaitKeeper(keeper, awaited);
  EndWhatIsLeft(status, g_state);
  if (!g_state->has_ended.load() && WIFSIGNALED(status)) {
    Say("the process that watches over the run (process " + std::to_string(keeper) +
        ") was killed, and the run with it; what it has written until then can be read");
  }
  if (WIFSIGNALED(status)) DieOf(WTERMSIG(status));
  return WEXITSTATUS(status);
}

}  // namespace tcs
