#include "coordinator/models/in_child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <exception>
#include <fstream>

#include "coordinator/port/unique_fd.h"

namespace tcs {
namespace {

// Exit statuses.
constexpr int kDone = 0, kThrew = 1, kNoMemory = 2, kNobodyListens = 3;

[[maybe_unused]] void LimitMemory() {
  constexpr rlim_t kMore = rlim_t{1} << 30;
  rlim_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlim_t most = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + kMore;
  const rlimit memory{most, most};
  setrlimit(RLIMIT_AS, &memory);
}

bool WriteAll(int fd, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t n = write(fd, text.data() + done, text.size() - done);
    if (n < 0 && errno != EINTR) return false;
    if (n > 0) done += static_cast<std::size_t>(n);
  }
  return true;
}

[[noreturn]] void Work(const std::function<std::string()>& work, unsigned most_seconds, int to,
                       pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(kNobodyListens);
  const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, fd);
  const rlimit none{0, 0}, processor{most_seconds, most_seconds};
  setrlimit(RLIMIT_CORE, &none);
  setrlimit(RLIMIT_CPU, &processor);
#ifndef __SANITIZE_ADDRESS__  // which reserves terabytes
  LimitMemory();
#endif
  for (const int signal : {SIGXCPU, SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL}) {
    ::signal(signal, SIG_DFL);
  }
  int status = kDone;
  try {
    if (!WriteAll(to, work())) status = kNobodyListens;
  } catch (const std::bad_alloc&) {
    status = kNoMemory;
  } catch (...) {
    status = kThrew;
  }
  _exit(status);
}

std::string FailureOf(int status, unsigned most_seconds) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU || signal == SIGKILL) {
      return fmt::format("reading it takes more than {} s of processor time", most_seconds);
    }
    return fmt::format("the library that reads it crashes ({})", strsignal(signal));
  }
  switch (WEXITSTATUS(status)) {
    case kDone:
      return {};
    case kNoMemory:
      return "reading it takes more than 1 GiB of memory";
    default:
      return "the library that reads it fails";
  }
}

}  // namespace

ChildWork DoInChild(const std::function<std::string()>& work, unsigned most_seconds,
                    std::size_t most_bytes) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return {{}, std::string("no pipe: ") + std::strerror(errno)};
  UniqueFd from(ends[0]), to(ends[1]);
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) return {{}, std::string("no process: ") + std::strerror(errno)};
  if (child == 0) {
    from.Reset();
    Work(work, most_seconds, to.get(), parent);
  }
  to.Reset();
  ChildWork done;
  pollfd readable{from.get(), POLLIN, 0};
  char piece[65'536];
  while (true) {
    const int ready = poll(&readable, 1, static_cast<int>(most_seconds) * 10'000);
    if (ready < 0 && errno == EINTR) continue;
    const ssize_t n = ready > 0 ? read(from.get(), piece, sizeof piece) : -1;
    if (n < 0 && ready > 0 && errno == EINTR) continue;
    if (n > 0) done.result.append(piece, static_cast<std::size_t>(n));
    if (n == 0) break;
    if (n > 0 && done.result.size() <= most_bytes) continue;
    kill(child, SIGKILL);
    break;
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  done.failure = FailureOf(status, most_seconds);
  return done;
}

}  // namespace tcs
