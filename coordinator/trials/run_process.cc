#include "coordinator/trials/run_process.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <utility>

#include "coordinator/os/own_network.h"
#include "coordinator/port/pidfds.h"

namespace tcs {

namespace {

// The child's half.
[[noreturn]] void Become(const RunProcessRequest& request, char** argv, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(127);
  UniqueFd log(open(request.log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND, 0666));
  UniqueFd null(open("/dev/null", O_RDONLY));
  if (!log || !null) _exit(127);
  dup2(null.get(), STDIN_FILENO);
  dup2(log.get(), STDOUT_FILENO);
  dup2(log.get(), STDERR_FILENO);
  null.Reset();
  log.Reset();
  if (request.own_network) {
    if (const std::string why = EnterOwnNetwork(); !why.empty()) {
      fprintf(stderr,
              "tcsim: this trial cannot have a network of its own: %s; try --host-network\n",
              why.c_str());
      _exit(2);
    }
  }
  sched_setaffinity(0, sizeof request.cpus, &request.cpus);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  execv("/proc/self/exe", argv);
  fprintf(stderr, "tcsim: tcsim itself cannot be started: %s\n", strerror(errno));
  _exit(2);
}

}  // namespace

std::string RunProcess::Start(const RunProcessRequest& request, RunProcess* process) {
  RunProcess started;
  // The child inherits the descriptor, so it is without MFD_CLOEXEC: the run sets that flag itself,
  // before it has clients.
  started.progress_.Reset(memfd_create("tcs-progress", 0));
  if (!started.progress_) return strerror(errno);
  std::vector<std::string> words{"tcsim"};
  words.insert(words.end(), request.arguments.begin(), request.arguments.end());
  words.insert(words.end(), {"--progress-fd", std::to_string(started.progress_.get())});
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t parent = getpid();
  started.pid_ = fork();
  if (started.pid_ == 0) Become(request, argv.data(), parent);
  if (started.pid_ < 0) return strerror(errno);
  // The runs that come after this one must not inherit the descriptor.
  fcntl(started.progress_.get(), F_SETFD, FD_CLOEXEC);
  started.pidfd_.Reset(OpenPidfd(started.pid_));
  if (!started.pidfd_) return strerror(errno);
  *process = std::move(started);
  return {};
}

RunProcess::RunProcess(RunProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      pidfd_(std::move(other.pidfd_)),
      progress_(std::move(other.progress_)) {}

RunProcess& RunProcess::operator=(RunProcess&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(pidfd_, other.pidfd_);
  std::swap(progress_, other.progress_);
  return *this;
}

RunProcess::~RunProcess() { EndInOrder(); }

std::int64_t RunProcess::virtual_ns() const {
  std::int64_t ns = 0;
  return pread(progress_.get(), &ns, sizeof ns, 0) == sizeof ns ? ns : 0;
}

void RunProcess::EndInOrder() const {
  if (pid_ > 0) kill(pid_, SIGTERM);
}

int RunProcess::Reap() {
  int status = -1;
  while (pid_ > 0 && waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  return status;
}

}  // namespace tcs
