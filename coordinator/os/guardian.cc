#include "coordinator/os/guardian.h"

#include <dirent.h>
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <map>
#include <vector>

namespace tcs {

namespace {

constexpr int kKillTurns = 400;  // of 5 ms
constexpr useconds_t kKillTurnUs = 5'000;

volatile sig_atomic_t g_coordinator = 0;

void PassOn(int signal) {
  if (g_coordinator > 0) kill(static_cast<pid_t>(g_coordinator), signal);
}

void Handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigaction(signal, &action, nullptr);
}

pid_t ParentOf(const char* pid) {
  char path[64], text[512];
  snprintf(path, sizeof path, "/proc/%.20s/stat", pid);
  FILE* file = fopen(path, "re");
  if (file == nullptr) return -1;
  const std::size_t n = fread(text, 1, sizeof text - 1, file);
  fclose(file);
  text[n] = '\0';
  // The name may hold anything; what follows its last parenthesis is: state, parent.
  const char* name_end = strrchr(text, ')');
  int parent = -1;
  if (name_end == nullptr || sscanf(name_end + 1, " %*c %d", &parent) != 1) return -1;
  return parent;
}

// All at once, not only the children: one that spins at real-time priority keeps its killed parent
// from the processor, and with it from dying, for ever.
void KillTree() {
  DIR* proc = opendir("/proc");
  if (proc == nullptr) return;
  std::multimap<pid_t, pid_t> children;
  while (const dirent* entry = readdir(proc)) {
    if (const int pid = atoi(entry->d_name); pid > 0)
      children.emplace(ParentOf(entry->d_name), pid);
  }
  closedir(proc);
  std::vector<pid_t> parents{getpid()};
  while (!parents.empty()) {
    const auto [first, last] = children.equal_range(parents.back());
    parents.pop_back();
    for (auto child = first; child != last; ++child) {
      kill(child->second, SIGKILL);
      parents.push_back(child->second);
    }
  }
}

// As the shell of a program that died of a signal would see it.
[[noreturn]] void DieOf(int signal_number) {
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  signal(signal_number, SIG_DFL);
  raise(signal_number);
  _exit(128 + signal_number);
}

}  // namespace

void KillDescendants() {
  for (int turn = 0; turn < kKillTurns; ++turn) {
    KillTree();
    pid_t reaped;
    while ((reaped = waitpid(-1, nullptr, WNOHANG)) > 0) {
    }
    if (reaped < 0 && errno == ECHILD) return;
    usleep(kKillTurnUs);
  }
}

int RunGuarded(const std::function<int()>& coordinate) {
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  // Until the handlers stand, nothing may get past them to the guardian alone.
  sigset_t passed_on, before;
  sigemptyset(&passed_on);
  for (const int signal : {SIGTERM, SIGHUP}) sigaddset(&passed_on, signal);
  sigprocmask(SIG_BLOCK, &passed_on, &before);
  const pid_t guardian = getpid();
  const pid_t coordinator = fork();
  if (coordinator == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != guardian) _exit(127);
    sigprocmask(SIG_SETMASK, &before, nullptr);
    // Not _exit: what the run printed is still to be flushed.
    exit(coordinate());
  }
  if (coordinator < 0) {
    fprintf(stderr, "tcsim: no process can be made: %s; end some, or raise `ulimit -u`\n",
            strerror(errno));
    return 2;
  }
  g_coordinator = coordinator;
  for (const int signal : {SIGTERM, SIGHUP}) Handle(signal, PassOn);
  for (const int signal : {SIGINT, SIGQUIT}) Handle(signal, SIG_IGN);
  sigprocmask(SIG_SETMASK, &before, nullptr);

  for (;;) {
    int status = 0;
    const pid_t pid = waitpid(coordinator, &status, WUNTRACED);
    if (pid < 0 && errno == EINTR) continue;
    if (pid == coordinator && WIFSTOPPED(status)) {
      raise(SIGSTOP);
      kill(coordinator, SIGCONT);
      continue;
    }
    KillDescendants();
    if (pid == coordinator && WIFSIGNALED(status)) DieOf(WTERMSIG(status));
    return pid == coordinator ? WEXITSTATUS(status) : 2;
  }
}

}  // namespace tcs
