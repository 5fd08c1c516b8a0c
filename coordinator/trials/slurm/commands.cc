#include "coordinator/trials/slurm/commands.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <sstream>

#include "coordinator/port/clocks.h"
#include "coordinator/port/unique_fd.h"

namespace tcs {

namespace {

constexpr std::int64_t kMostNs = 60'000'000'000;
constexpr int kNotFound = 127;

struct Pipe {
  UniqueFd read, write;
  Pipe() {
    int fds[2];
    if (pipe2(fds, O_CLOEXEC) == 0) {
      read.Reset(fds[0]);
      write.Reset(fds[1]);
    }
  }
};

[[noreturn]] void Become(char** argv, int out, int said) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int null = open("/dev/null", O_RDONLY | O_CLOEXEC);
  dup2(null, STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(said, STDERR_FILENO);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  execvp(argv[0], argv);
  _exit(kNotFound);
}

// False at the end of what `fd` has.
bool ReadSome(int fd, std::string* text) {
  char block[65536];
  const ssize_t n = read(fd, block, sizeof block);
  if (n > 0) text->append(block, static_cast<std::size_t>(n));
  return n > 0 || (n < 0 && errno == EINTR);
}

}  // namespace

CommandResult RunSlurmCommand(const std::vector<std::string>& words) {
  std::vector<std::string> copies = words;
  std::vector<char*> argv;
  for (std::string& word : copies) argv.push_back(word.data());
  argv.push_back(nullptr);
  CommandResult result;
  Pipe out, said;
  const pid_t pid = out.read && said.read ? fork() : -1;
  if (pid == 0) Become(argv.data(), out.write.get(), said.write.get());
  if (pid < 0) {
    result.said = strerror(errno);
    return result;
  }
  out.write.Reset();
  said.write.Reset();
  const std::int64_t until_ns = HostClockNs(CLOCK_MONOTONIC) + kMostNs;
  bool is_late = false;
  while (out.read || said.read) {
    pollfd fds[]{{out.read.get(), POLLIN, 0}, {said.read.get(), POLLIN, 0}};
    const std::int64_t left_ns = until_ns - HostClockNs(CLOCK_MONOTONIC);
    if (!is_late && left_ns <= 0) {
      is_late = true;
      kill(pid, SIGKILL);
    }
    if (poll(fds, 2, is_late ? -1 : static_cast<int>(left_ns / 1'000'000) + 1) <= 0) continue;
    if (fds[0].revents != 0 && !ReadSome(fds[0].fd, &result.out)) out.read.Reset();
    if (fds[1].revents != 0 && !ReadSome(fds[1].fd, &result.said)) said.read.Reset();
  }
  int status = -1;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  result.is_found = !(WIFEXITED(status) && WEXITSTATUS(status) == kNotFound);
  result.succeeded = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (is_late) result.said = words[0] + ": error: no answer within a minute";
  return result;
}

std::string SlurmsReason(const std::string& said) {
  std::string reason;
  std::istringstream lines(said);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) continue;
    const std::string mark = "error: ";
    if (const std::size_t at = line.find(mark); at != std::string::npos) {
      line.erase(0, at + mark.size());
    }
    const std::string failed = "Batch job submission failed: ";
    if (line.compare(0, failed.size(), failed) == 0) return line.substr(failed.size());
    reason += (reason.empty() ? "" : "; ") + line;
  }
  return reason.empty() ? "no reason given" : reason;
}

}  // namespace tcs
