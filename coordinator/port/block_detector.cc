#include "coordinator/port/block_detector.h"

#include <sched.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <optional>

#include "coordinator/port/bare_process.h"
#include "coordinator/port/levels.h"
#include "coordinator/port/pidfds.h"
#include "coordinator/port/proc_files.h"

namespace tcs {

namespace {

// A process of its own and not a thread: a killed coordinator must not have to wait for a thread
// that may never get the processor again before the coordinator's end is known.
[[noreturn]] void Detect(int arm, int fired) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const bool has_level = SetLevel(0, Level::kKernelOnly);  // until it has no memory to give up
  constexpr int kArm = 0, kFired = 1;
  if (dup2(arm, kArm) == kArm && dup2(fired, kFired) == kFired) {
    close_range(2, ~0u, 0);
    RelayInBareProcess(has_level ? SCHED_FIFO : SCHED_IDLE,
                       has_level ? static_cast<int>(Level::kDetector) : 0);
    if (!SetLevel(0, Level::kDetector)) RunOnlyWhenIdle();
    std::uint64_t count = 0;
    const std::uint64_t one = 1;
    while (read(kArm, &count, sizeof count) == sizeof count) {
      if (write(kFired, &one, sizeof one) != sizeof one) break;
    }
  }
  _exit(0);
}

}  // namespace

BlockDetector::~BlockDetector() {
  if (!pidfd_) return;
  // By the pidfd and not by the process's number, which may be another's by now.
  KillByPidfd(pidfd_.get());
  siginfo_t info;
  waitid(P_PIDFD, static_cast<id_t>(pidfd_.get()), &info, WEXITED);
}

std::string BlockDetector::Start() {
  arm_.Reset(eventfd(0, EFD_CLOEXEC));
  fired_.Reset(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  const pid_t coordinator = getpid();
  const pid_t detector = fork();
  if (detector < 0) return "the block detector's process cannot be made";
  if (detector == 0) {
    if (getppid() != coordinator) _exit(0);
    Detect(arm_.get(), fired_.get());
  }
  pid_ = detector;
  pidfd_.Reset(OpenPidfd(detector));
  return {};
}

void BlockDetector::Arm() {
  if (armed_) return;
  const std::uint64_t one = 1;
  armed_ = write(arm_.get(), &one, sizeof one) == sizeof one;
}

bool BlockDetector::TakeFired() {
  std::uint64_t count;
  if (read(fired_.get(), &count, sizeof count) != sizeof count) return false;
  armed_ = false;
  return true;
}

bool BlockDetector::IsDying() const { return tcs::IsDying(pid_); }

std::string BlockDetector::HowItEnded() const {
  const std::optional<int> status = WaitStatusOf(pid_);
  const int signal = status.has_value() ? WTERMSIG(*status) : SIGKILL;
  return "the block detector (process " + std::to_string(pid_) + ") was killed by signal " +
         std::to_string(signal) +
         ", and the run cannot go on without it; what it has written until then can be read";
}

}  // namespace tcs
