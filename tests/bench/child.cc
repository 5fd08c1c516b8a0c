#include "tests/bench/child.h"

#include <errno.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>

namespace tcs::bench {

namespace {

using std::chrono::steady_clock;

[[noreturn]] void BecomeProgram(const Command& command, pid_t parent, int out) {
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

struct Running {
  pid_t pid = -1;
  int output = -1;
};

// A negative pid: none could be made.
Running Start(const Command& command) {
  int out[2];
  if (pipe2(out, O_CLOEXEC) != 0) return {};
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) BecomeProgram(command, parent, out[1]);
  close(out[1]);
  return {child, out[0]};
}

// Of all of them; false if `deadline` came before the last one's end.
bool ReadToEnds(std::vector<Running> running, steady_clock::time_point deadline,
                std::vector<ChildResult>* results) {
  std::size_t open = 0;
  for (const Running& child : running) open += child.output >= 0 ? 1 : 0;
  while (open > 0) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - steady_clock::now());
    std::vector<pollfd> readable;
    for (const Running& child : running) readable.push_back({child.output, POLLIN, 0});
    if (left.count() <= 0 ||
        poll(readable.data(), readable.size(), static_cast<int>(left.count())) == 0) {
      return false;
    }
    for (std::size_t i = 0; i < running.size(); ++i) {
      if (readable[i].revents == 0) continue;
      char buffer[4096];
      const ssize_t n = read(running[i].output, buffer, sizeof buffer);
      if (n > 0) {
        (*results)[i].output.append(buffer, static_cast<std::size_t>(n));
      } else {
        running[i].output = -1;  // poll ignores it
        --open;
      }
    }
  }
  return true;
}

double Seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) / 1e6;
}

void AwaitEnd(const Running& child, const std::string& name, ChildResult* result) {
  if (child.pid < 0) {
    result->error = "no process can be made";
    return;
  }
  int status = 0;
  rusage usage{};
  while (wait4(child.pid, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  result->cpu_seconds = Seconds(usage.ru_utime) + Seconds(usage.ru_stime);
  if (!WIFEXITED(status)) {
    result->error = fmt::format("{} was killed by signal {}", name, WTERMSIG(status));
  } else if (WEXITSTATUS(status) != 0) {
    result->error = fmt::format("{} ended with status {}", name, WEXITSTATUS(status));
  }
}

}  // namespace

std::vector<ChildResult> RunTogether(const std::vector<Command>& commands,
                                     std::chrono::seconds longest) {
  std::vector<ChildResult> results(commands.size());
  std::vector<Running> running;
  for (const Command& command : commands) running.push_back(Start(command));
  const bool in_time = ReadToEnds(running, steady_clock::now() + longest, &results);
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (running[i].output >= 0) close(running[i].output);
    if (!in_time && running[i].pid > 0) kill(running[i].pid, SIGKILL);
    AwaitEnd(running[i], commands[i][0], &results[i]);
    if (!in_time) {
      results[i].error = fmt::format("{} took more than {} s", commands[i][0], longest.count());
    }
  }
  return results;
}

ChildResult RunChild(const Command& command, std::chrono::seconds longest) {
  return RunTogether({command}, longest).front();
}

}  // namespace tcs::bench
