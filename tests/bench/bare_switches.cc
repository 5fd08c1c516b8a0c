#include "tests/bench/bare_switches.h"

#include <fmt/format.h>
#include <linux/futex.h>
#include <sched.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <new>
#include <vector>

#include "coordinator/port/unique_fd.h"

namespace tcs::bench {

namespace {

using Clock = std::chrono::steady_clock;

// As a run has them, where that is permitted. Whoever hangs is killed with its parent.
constexpr int kRunsAt = 12, kSwitchesAt = 13;
constexpr int kLongestWaitMs = 30'000;  // another run may have the processor

void SetPriority(int priority) {
  const sched_param param{priority};
  sched_setscheduler(0, priority > 0 ? SCHED_FIFO : SCHED_OTHER, &param);
}

// In a page of its own, as clients' slots are.
using Gate = std::atomic<std::uint32_t>;

long Futex(Gate* gate, int command, std::uint32_t value) {
  return syscall(SYS_futex, gate, command, value, nullptr);
}

[[noreturn]] void TakeTurns(Gate* gate, int answers) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  SetPriority(kRunsAt);
  for (const char done = 0;;) {
    while (gate->load() == 0) Futex(gate, FUTEX_WAIT, 0);
    gate->store(0);
    if (write(answers, &done, sizeof done) != sizeof done) _exit(1);
  }
}

class Ring {
 public:
  explicit Ring(int processes) : epoll_(epoll_create1(EPOLL_CLOEXEC)) {
    for (int i = 0; i < processes && is_complete_; ++i) is_complete_ = Add(i);
  }
  ~Ring() {
    for (const pid_t pid : pids_) kill(pid, SIGKILL);
    for (const pid_t pid : pids_) waitpid(pid, nullptr, 0);
    for (Gate* gate : gates_) munmap(gate, sizeof *gate);
  }
  Ring(const Ring&) = delete;
  Ring& operator=(const Ring&) = delete;

  bool is_complete() const { return is_complete_; }

  // Each process's turn once; false if one does not answer.
  bool GoRound() {
    for (Gate* gate : gates_) {
      gate->store(1);
      Futex(gate, FUTEX_WAKE, 1);
      epoll_event event;
      if (epoll_wait(epoll_.get(), &event, 1, kLongestWaitMs) != 1) return false;
      char done;
      if (read(answers_[event.data.u32].get(), &done, sizeof done) != sizeof done) return false;
    }
    return true;
  }

 private:
  bool Add(int number) {
    void* page =
        mmap(nullptr, sizeof(Gate), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    int ends[2];
    if (page == MAP_FAILED || pipe(ends) != 0) return false;
    gates_.push_back(new (page) Gate(0));
    const UniqueFd says(ends[1]);
    answers_.emplace_back(ends[0]);
    epoll_event event{.events = EPOLLIN, .data = {.u32 = static_cast<std::uint32_t>(number)}};
    if (epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, ends[0], &event) != 0) return false;
    const pid_t pid = fork();
    if (pid == 0) TakeTurns(gates_.back(), says.get());
    if (pid > 0) pids_.push_back(pid);
    return pid > 0;
  }

  UniqueFd epoll_;
  std::vector<Gate*> gates_;
  std::vector<UniqueFd> answers_;
  std::vector<pid_t> pids_;
  bool is_complete_ = true;
};

}  // namespace

std::optional<double> MeasureBareSwitches(int processes, int turns) {
  Ring ring(processes);
  SetPriority(kSwitchesAt);
  const int rounds = std::max(1, turns / processes);
  bool is_right = ring.is_complete() && ring.GoRound();
  const auto begun = Clock::now();
  for (int round = 0; round < rounds && is_right; ++round) is_right = ring.GoRound();
  const std::chrono::duration<double, std::micro> took = Clock::now() - begun;
  SetPriority(0);
  if (is_right) return took.count() / rounds / processes;
  fmt::print(stderr, "tcs_bench: dispatch: {} processes cannot be had, or do not answer\n",
             processes);
  return std::nullopt;
}

}  // namespace tcs::bench
