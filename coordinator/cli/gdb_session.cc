#include "coordinator/cli/gdb_session.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <initializer_list>
#include <new>
#include <string>

#include "coordinator/cli/basics/exit_status.h"
#include "coordinator/port/unique_fd.h"

namespace tcs {

namespace {

// Makes the group the terminal's job, as a shell does. Without a terminal the call does nothing.
void GiveTerminalTo(pid_t group) { tcsetpgrp(STDIN_FILENO, group); }

[[noreturn]] void ExecGdb(pid_t debuggee) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  setpgid(0, 0);
  if (isatty(STDIN_FILENO) == 1) GiveTerminalTo(getpid());
  for (const int signal : {SIGINT, SIGQUIT, SIGTTOU}) ::signal(signal, SIG_DFL);
  const std::string pid = std::to_string(debuggee);
  // By signal 33 tcsim stops threads where it may not have real-time priority.
  execlp("gdb", "gdb", "-q", "-iex", "set pagination off", "-ex",
         "handle SIG33 nostop noprint pass", "-p", pid.c_str(), static_cast<char*>(nullptr));
  Fail(std::string("gdb cannot be started: ") + strerror(errno) + "; install it (apt install gdb)");
  _exit(kNoSuchProgram);
}

// Runs gdb until gdb has ended.
void RunGdb(pid_t debuggee) {
  const pid_t gdb = fork();
  if (gdb == 0) ExecGdb(debuggee);
  int status = 0;
  if (gdb > 0) waitpid(gdb, &status, 0);
  if (isatty(STDIN_FILENO) == 1) GiveTerminalTo(getpgrp());
}

int StatusOf(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : InterruptedBy(WTERMSIG(status));
}

}  // namespace

int RunWithGdb(const std::function<int(const GdbSession& session)>& run) {
  int ends[2];
  void* page = mmap(nullptr, sizeof(std::atomic<bool>), PROT_READ | PROT_WRITE,
                    MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (page == MAP_FAILED || pipe2(ends, O_CLOEXEC) != 0) {
    return Fail(std::string("gdb cannot be prepared: ") + strerror(errno));
  }
  auto* has_ended = new (page) std::atomic<bool>(false);
  UniqueFd from(ends[0]), to(ends[1]);
  const pid_t parent = getpid(), child = fork();
  if (child < 0) return Fail(std::string("no process can be made: ") + strerror(errno));
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) _exit(kCannotRun);
    from.Reset();
    exit(run({[&to](pid_t debuggee) {
                const ssize_t written = write(to.get(), &debuggee, sizeof debuggee);
                static_cast<void>(written);  // without a reader this process ends, too
              },
              [has_ended] { return has_ended->load(); }}));
  }
  to.Reset();
  // ^C is for gdb while it has the terminal; before and afterwards it reaches the run by itself.
  for (const int signal : {SIGINT, SIGQUIT, SIGTTOU}) ::signal(signal, SIG_IGN);
  pid_t debuggee = 0;
  if (read(from.get(), &debuggee, sizeof debuggee) == sizeof debuggee) RunGdb(debuggee);
  has_ended->store(true);
  return StatusOf(child);
}

}  // namespace tcs
