// attacker: a client that does to tcsim's own processes what the kernel would let one of the same
// user do, past the shim where that could help. 0 if all of it was refused, and they live.
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "shm/layout.h"

namespace {

int g_failures = 0;
volatile sig_atomic_t g_signals = 0;

void Expect(bool holds, const char* what, pid_t victim) {
  if (holds) return;
  fprintf(stderr, "attacker: %s on process %d: %s\n", what, victim, strerror(errno));
  ++g_failures;
}

#define REFUSED(victim, call)                              \
  do {                                                     \
    errno = 0;                                             \
    const long result = (call);                            \
    Expect(result == -1 && errno == EPERM, #call, victim); \
  } while (false)

// What follows the name in /proc/PID/stat, from the state on.
std::vector<std::string> StatOf(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text, word;
  std::getline(file, text);
  std::istringstream rest(text.substr(std::min(text.size(), text.rfind(')') + 2)));
  std::vector<std::string> words;
  while (rest >> word) words.push_back(word);
  return words;
}

pid_t ParentOf(pid_t pid) { return atoi(StatOf(pid).at(1).c_str()); }

std::string NameOf(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/comm");
  std::string name;
  std::getline(file, name);
  return name;
}

// The coordinator, those above it, and the block detector.
std::vector<pid_t> Victims() {
  std::vector<pid_t> victims;
  const pid_t coordinator = getppid();
  const std::string name = NameOf(coordinator);
  for (pid_t pid = coordinator; NameOf(pid) == name; pid = ParentOf(pid)) victims.push_back(pid);
  std::ifstream children("/proc/" + std::to_string(coordinator) + "/task/" +
                         std::to_string(coordinator) + "/children");
  for (pid_t child; children >> child;) {
    if (NameOf(child) == name) victims.push_back(child);
  }
  return victims;
}

// As the shim marks its own calls.
long Marked(long number, long a, long b, long c = 0, long d = 0) {
  return syscall(number, a, b, c, d, 0L, static_cast<long>(tcs::shm::kOwnCallMark));
}

void Signal(pid_t v) {
  for (const int signal : {SIGSTOP, SIGKILL, SIGTERM, SIGUSR1}) {
    REFUSED(v, kill(v, signal));
    REFUSED(v, syscall(SYS_kill, v, signal));
    REFUSED(v, Marked(SYS_kill, v, signal));
    REFUSED(v, Marked(SYS_tkill, v, signal));
    REFUSED(v, Marked(SYS_tgkill, v, v, signal));
    REFUSED(v, tgkill(v, v, signal));
    REFUSED(v, sigqueue(v, signal, {}));
    siginfo_t info{};
    info.si_signo = signal;
    info.si_code = SI_QUEUE;
    REFUSED(v, Marked(SYS_rt_sigqueueinfo, v, signal, reinterpret_cast<long>(&info)));
    REFUSED(v, Marked(SYS_rt_tgsigqueueinfo, v, v, signal, reinterpret_cast<long>(&info)));
  }
  Expect(kill(v, 0) == 0, "the question whether it lives", v);
}

void SignalByDescriptor(pid_t v) {
  const std::string folder = "/proc/" + std::to_string(v);
  for (const int fd : {static_cast<int>(syscall(SYS_pidfd_open, v, 0)),
                       open(folder.c_str(), O_RDONLY | O_DIRECTORY)}) {
    Expect(fd >= 0, "no descriptor", v);
    REFUSED(v, syscall(SYS_pidfd_send_signal, fd, SIGSTOP, nullptr, 0));
    REFUSED(v, Marked(SYS_pidfd_send_signal, fd, SIGSTOP));
    REFUSED(v, Marked(SYS_pidfd_getfd, fd, 0));
    close(fd);
  }
  int ends[2];
  socketpair(AF_UNIX, SOCK_STREAM, 0, ends);
  f_owner_ex owner{F_OWNER_PID, v}, group{F_OWNER_PGRP, getpgid(v)};
  int number = v, groups = -getpgid(v);
  REFUSED(v, fcntl(ends[0], F_SETOWN, v));
  REFUSED(v, fcntl(ends[0], F_SETOWN, -getpgid(v)));
  REFUSED(v, fcntl(ends[0], F_SETOWN_EX, &owner));
  REFUSED(v, fcntl(ends[0], F_SETOWN_EX, &group));
  REFUSED(v, ioctl(ends[0], FIOSETOWN, &number));
  REFUSED(v, ioctl(ends[0], SIOCSPGRP, &groups));
  close(ends[0]);
  close(ends[1]);
}

void Trace(pid_t v) {
  REFUSED(v, ptrace(PTRACE_ATTACH, v, nullptr, nullptr));
  REFUSED(v, ptrace(PTRACE_SEIZE, v, nullptr, nullptr));
  char mine = 0;
  iovec local{&mine, 1}, remote{&mine, 1};
  REFUSED(v, process_vm_writev(v, &local, 1, &remote, 1, 0));
  REFUSED(v, process_vm_readv(v, &local, 1, &remote, 1, 0));
}

void Starve(pid_t v) {
  const rlimit none{1, 1};
  REFUSED(v, prlimit(v, RLIMIT_CPU, &none, nullptr));
  REFUSED(v, syscall(SYS_setpriority, PRIO_PROCESS, v, 19));
  const std::vector<std::string> before = StatOf(v);
  const sched_param param{};
  Marked(SYS_sched_setscheduler, v, SCHED_OTHER, reinterpret_cast<long>(&param));
  syscall(SYS_sched_setscheduler, v, SCHED_OTHER, &param);
  sched_setscheduler(v, SCHED_OTHER, &param);
  constexpr std::size_t kPolicy = 38;
  Expect(StatOf(v).at(kPolicy) == before.at(kPolicy), "another policy", v);
}

// By the calls of 32-bit programs. In a child: a kernel without them kills it.
void SignalIn32Bits(pid_t v) {
  constexpr int kKill = 37, kStop = SIGSTOP;
  const pid_t child = fork();
  if (child == 0) {
    int result = kKill;
    __asm__ volatile("int $0x80" : "+a"(result) : "b"(v), "c"(kStop) : "memory");
    _exit(result == -EPERM || result == -ENOSYS ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  Expect(WIFSIGNALED(status) || WEXITSTATUS(status) == 0, "kill by a 32-bit call", v);
}

void Count(int) { g_signals = g_signals + 1; }

// Everybody, and one's own group, are those on the robot.
void SignalMany(const std::vector<pid_t>& victims) {
  signal(SIGUSR1, Count);
  int ready[2];
  if (pipe(ready) != 0) _exit(2);
  const pid_t child = fork();
  if (child == 0) {
    const char one = 1;
    if (write(ready[1], &one, 1) != 1) _exit(1);
    while (g_signals == 0) pause();
    _exit(7);
  }
  char one;
  if (read(ready[0], &one, 1) != 1) _exit(2);
  Expect(kill(-1, SIGUSR1) == 0, "kill of everybody", -1);
  Expect(g_signals == 0, "a signal to oneself by kill of everybody", -1);
  int status = 0;
  Expect(waitpid(child, &status, 0) == child && WEXITSTATUS(status) == 7,
         "everybody does not have a child in it", -1);
  Expect(kill(0, SIGUSR1) == 0 && g_signals == 1, "kill of one's group", 0);
  Expect(killpg(getpgrp(), SIGUSR1) == 0 && g_signals == 2, "killpg", 0);
  Expect(Marked(SYS_kill, 0, SIGUSR1) == 0 && g_signals == 3, "a marked kill of one's group", 0);
  Expect(syscall(SYS_kill, -getpgrp(), SIGUSR1) == 0 && g_signals == 4, "a raw kill", 0);
  for (const pid_t v : victims) {
    if (setpgid(0, v) == 0) kill(0, SIGUSR1);
    kill(-v, SIGUSR1);
    Marked(SYS_kill, -v, SIGUSR1);
  }
}

}  // namespace

int main() {
  const std::vector<pid_t> victims = Victims();
  Expect(victims.size() >= 4, "not all of tcsim's processes were found", getppid());
  for (const pid_t v : victims) {
    Signal(v);
    SignalByDescriptor(v);
    Trace(v);
    Starve(v);
    SignalIn32Bits(v);
  }
  REFUSED(getppid(), ptrace(PTRACE_TRACEME, 0, nullptr, nullptr));
  const pid_t group = getpgrp();
  SignalMany(victims);
  setpgid(0, group);
  usleep(100'000);
  for (const pid_t v : victims) {
    const std::string state = StatOf(v).at(0);
    Expect(state == "S" || state == "R" || state == "D", ("its state is " + state).c_str(), v);
  }
  if (g_failures == 0) puts("all refused");
  return g_failures == 0 ? 0 : 1;
}
