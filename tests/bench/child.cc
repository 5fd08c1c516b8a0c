#include "tests/bench/child.h"

#include <errno.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>

namespace tcs::bench {

namespace {

using std::chrono::steady_clock;
constexpr std::chrono::seconds kLongestLife{30};

[[noreturn]] void BecomeProgram(const std::vector<std::string>& command, pid_t parent, int out) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);
  dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  std::vector<char*> argv;
  for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  execvp(argv[0], argv.data());
  fmt::print(stderr, "tcs_bench: {} cannot be started: {}\n", command[0], strerror(errno));
  _exit(127);
}

// False if `deadline` came before the end of the output.
bool ReadToEnd(int fd, steady_clock::time_point deadline, std::string* output) {
  for (;;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - steady_clock::now());
    pollfd readable{fd, POLLIN, 0};
    if (left.count() <= 0 || poll(&readable, 1, static_cast<int>(left.count())) == 0) return false;
    char buffer[4096];
    const ssize_t n = read(fd, buffer, sizeof buffer);
    if (n <= 0) return true;
    output->append(buffer, static_cast<std::size_t>(n));
  }
}

}  // namespace

ChildResult RunChild(const std::vector<std::string>& command) {
  int out[2];
  if (pipe2(out, O_CLOEXEC) != 0) return {"", "no pipe can be made"};
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) BecomeProgram(command, parent, out[1]);
  close(out[1]);
  ChildResult result;
  const bool in_time =
      child > 0 && ReadToEnd(out[0], steady_clock::now() + kLongestLife, &result.output);
  close(out[0]);
  if (child < 0) {
    result.error = "no process can be made";
    return result;
  }
  if (!in_time) kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  if (!in_time) {
    result.error = fmt::format("{} took more than {} s", command[0], kLongestLife.count());
  } else if (!WIFEXITED(status)) {
    result.error = fmt::format("{} was killed by signal {}", command[0], WTERMSIG(status));
  } else if (WEXITSTATUS(status) != 0) {
    result.error = fmt::format("{} ended with status {}", command[0], WEXITSTATUS(status));
  }
  return result;
}

}  // namespace tcs::bench
