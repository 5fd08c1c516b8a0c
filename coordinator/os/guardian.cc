#include "coordinator/os/guardian.h"

#include <dirent.h>
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <new>
#include <vector>

#include "coordinator/os/host.h"

namespace tcs {

namespace {

constexpr int kKillTurns = 400;  // of 5 ms
constexpr useconds_t kKillTurnUs = 5'000;

volatile sig_atomic_t g_coordinator = 0, g_is_to_stop = 0;
GuardLimits g_limits;
// In memory that both processes share.
std::atomic<std::uint64_t>* g_beats = nullptr;
std::uint64_t g_beats_seen = 0;
std::int64_t g_computed_ns = 0;

void PassOn(int signal) {
  if (g_coordinator <= 0) return;
  kill(static_cast<pid_t>(g_coordinator), signal);
  g_is_to_stop = 1;
  alarm(g_limits.stop_within_s);
}

// ^C at a terminal reaches the child by itself; what somebody has sent, only this process may have.
void PassOnInterrupt(int signal, siginfo_t* info, void*) {
  if (info->si_code != SI_KERNEL) PassOn(signal);
}

void EndIt(const char* sentence) {
  const ssize_t n = write(STDERR_FILENO, sentence, strlen(sentence));
  static_cast<void>(n);
  // In the kernel it may spin for something that its priority prevents.
  LeaveRealTime(static_cast<pid_t>(g_coordinator));
  kill(static_cast<pid_t>(g_coordinator), SIGKILL);
}

// In the handler of SIGALRM.
void Look(int) {
  const auto pid = static_cast<pid_t>(g_coordinator);
  if (pid <= 0) return;
  if (g_is_to_stop != 0) return EndIt("tcsim: the run did not stop in time, and is killed\n");
  const std::uint64_t beats = g_beats->load();
  const std::int64_t computed_ns = std::max<std::int64_t>(0, ProcessCpuClockNs(pid));
  const bool busy = computed_ns - g_computed_ns > std::int64_t{g_limits.look_every_s} * 800'000'000;
  if (busy && beats == g_beats_seen) {
    return EndIt(
        "tcsim: the coordinator computes without getting on, and is killed; this is a fault of "
        "tcsim, please report it\n");
  }
  g_beats_seen = beats;
  g_computed_ns = computed_ns;
  alarm(g_limits.look_every_s);
}

void MakeBeats() {
  void* page =
      mmap(nullptr, sizeof *g_beats, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (page != MAP_FAILED) g_beats = new (page) std::atomic<std::uint64_t>(0);
}

void Handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigaction(signal, &action, nullptr);
}

// All at once, not only the children: one that spins at real-time priority keeps its killed parent
// from the processor, and with it from dying, for ever.
void KillTree() {
  DIR* proc = opendir("/proc");
  if (proc == nullptr) return;
  std::multimap<pid_t, pid_t> children;
  while (const dirent* entry = readdir(proc)) {
    if (const int pid = atoi(entry->d_name); pid > 0) children.emplace(ParentOf(pid), pid);
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

void Beat() {
  if (g_beats != nullptr) g_beats->fetch_add(1, std::memory_order_relaxed);
}

int RunGuarded(const std::function<int()>& coordinate, GuardLimits limits) {
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  g_limits = limits;
  MakeBeats();
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
  Handle(SIGALRM, Look);
  if (g_beats != nullptr) alarm(limits.look_every_s);
  Handle(SIGQUIT, SIG_IGN);
  struct sigaction interrupt {};
  interrupt.sa_sigaction = PassOnInterrupt;
  interrupt.sa_flags = SA_RESTART | SA_SIGINFO;
  sigaction(SIGINT, &interrupt, nullptr);
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
    alarm(0);
    KillDescendants();
    if (pid == coordinator && WIFSIGNALED(status)) DieOf(WTERMSIG(status));
    return pid == coordinator ? WEXITSTATUS(status) : 2;
  }
}

}  // namespace tcs
