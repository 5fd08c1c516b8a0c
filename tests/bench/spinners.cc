#include "tests/bench/spinners.h"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tcs::bench {

namespace {

constexpr unsigned kLongestLifeSeconds = 120;

[[noreturn]] void Spin(pid_t owner) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  signal(SIGALRM, SIG_DFL);
  alarm(kLongestLifeSeconds);
  if (getppid() != owner) _exit(0);
  for (;;) __asm__ volatile("" : : : "memory");
}

}  // namespace

Spinners::Spinners(int count) {
  const pid_t owner = getpid();
  for (int i = 0; i < count; ++i) {
    const pid_t pid = fork();
    if (pid == 0) Spin(owner);
    if (pid > 0) pids_.push_back(pid);
    complete_ = complete_ && pid > 0;
  }
}

Spinners::~Spinners() {
  for (const pid_t pid : pids_) kill(pid, SIGKILL);
  for (const pid_t pid : pids_) waitpid(pid, nullptr, 0);
}

}  // namespace tcs::bench
