#include "coordinator/os/spawning.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/close_range.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/personality.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <optional>
#include <span>
#include <utility>

#include "coordinator/os/open_file_limit.h"
#include "coordinator/os/passed_fd.h"
#include "coordinator/os/say.h"
#include "coordinator/port/levels.h"
#include "shm/layout.h"

namespace tcs {

namespace {

// The child's half of the hand-over of its trap: sends the descriptor, or why there is none, and
// waits until the parent has closed its end.
void HandOverTrap(int to_parent, const SpawnRequest& request) {
  const UniqueFd listener(InstallTrap(request.guarded, request.trapped_too));
  // From here on calls are trapped, and nobody takes them yet.
  const long own = shm::kOwnCallMark;
  int error = listener ? 0 : errno;
  const int fd = listener.get();
  PassedMessage message(&error, sizeof error, std::span(&fd, listener ? 1 : 0));
  if (syscall(SYS_sendmsg, to_parent, message.get(), MSG_NOSIGNAL, 0, 0, own) < 0) _exit(127);
  char none;
  while (syscall(SYS_read, to_parent, &none, 1, 0, 0, own) < 0 && errno == EINTR) {
  }
}

// None: errno says why.
UniqueFd TakeOverTrap(int from_child) {
  int error = ECHILD;
  Passed passed = ReceivePassed(from_child, &error, sizeof error, 0);
  errno = error;
  return std::move(passed.fd);
}

}  // namespace

int WhyNoFixedLayout() {
  constexpr unsigned long kTellOnly = 0xffffffff;
  char randomizes = 0;
  std::ifstream("/proc/sys/kernel/randomize_va_space") >> randomizes;
  if (randomizes == '0') return 0;
  const int own = personality(kTellOnly);
  if (own < 0 || personality(static_cast<unsigned>(own) | ADDR_NO_RANDOMIZE) < 0) return errno;
  personality(static_cast<unsigned>(own));
  return 0;
}

Spawned Spawn(const SpawnRequest& request) {
  std::vector<char*> argv;
  for (const std::string& word : request.command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  std::optional<SocketPair> sockets = SocketPair::Make();
  if (!sockets.has_value()) return {};
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid != 0) {
    sockets->theirs.Reset();
    Spawned spawned{pid, {}};
    if (pid > 0) {
      // The child comes this far at our own level; for the rest it waits for its dispatch. The
      // level is set here, not in the child, which next runs when it has been given another one.
      spawned.trap = TakeOverTrap(sockets->ours.get());
      SetLevel(pid, Level::kWaiting);
    }
    return spawned;
  }
  sockets->ours.Reset();
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);
  RestoreOpenFileLimit();
  if (request.computer != nullptr && !EnterComputer(*request.computer)) {
    Say(std::string(argv[0]) + " cannot be put into its robot's network: " + strerror(errno));
    _exit(127);
  }
  HandOverTrap(sockets->theirs.get(), request);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  signal(SIGINT, SIG_DFL);
  signal(SIGPIPE, SIG_DFL);
  if (request.fixed_layout) personality(ADDR_NO_RANDOMIZE);
  for (const auto& [name, value] : request.environment) {
    setenv(name.c_str(), value.c_str(), 1);
  }
  auto redirect = [](const std::string& path, int to) {
    if (path.empty()) return;
    const UniqueFd fd(open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644));
    if (fd) dup2(fd.get(), to);
  };
  redirect(request.log_stdout, 1);
  redirect(request.log_stderr, 2);
  if (!request.log_stdout.empty()) {
    const int null = open("/dev/null", O_RDONLY);
    dup2(null, 0);
    // The program gets nothing that tcsim has open, or was started with: the numbers that a program
    // gets for its own descriptors are part of what repeats.
    close_range(3, ~0u, CLOSE_RANGE_CLOEXEC);
  }
  if (!request.working_directory.empty() && chdir(request.working_directory.c_str()) != 0) {
    fprintf(stderr, "tcsim: the working directory %s cannot be entered: %s\n",
            request.working_directory.c_str(), strerror(errno));
    _exit(127);
  }
  execvp(argv[0], argv.data());
  const int error = errno;
  Say(std::string(argv[0]) + " cannot be started: " + strerror(error));
  _exit(error == ENOENT ? 127 : 126);
}

}  // namespace tcs
