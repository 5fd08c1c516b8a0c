#include "coordinator/os/strays.h"

#include <sched.h>

#include <fstream>

#include "coordinator/port/levels.h"

namespace tcs {

namespace {

// A thread that forks while it is looked for has children with its priority. None of theirs has it.
constexpr int kMostPasses = 8;
constexpr int kPidMaxByDefault = 32'768;

bool HasLevelOfARun(int tid) {
  if ((sched_getscheduler(tid) & ~SCHED_RESET_ON_FORK) != SCHED_FIFO) return false;
  sched_param param{};
  return sched_getparam(tid, &param) == 0 &&
         param.sched_priority >= static_cast<int>(Level::kWaiting) &&
         param.sched_priority <= static_cast<int>(Level::kKernelOnly);
}

}  // namespace

std::vector<pid_t> RealTimeThreadsOn(int cpu, int pid_max) {
  std::vector<pid_t> found;
  for (pid_t tid = 2; tid <= pid_max; ++tid) {
    if (HasLevelOfARun(tid) && IsBoundTo(tid, cpu)) found.push_back(tid);
  }
  return found;
}

void LowerStraysOn(int cpu, int pid_max) {
  SetLevel(0, Level::kKernelOnly);  // before those that spin, where that is permitted
  bool found = true;
  for (int pass = 0; found && pass < kMostPasses; ++pass) {
    const std::vector<pid_t> threads = RealTimeThreadsOn(cpu, pid_max);
    for (const pid_t tid : threads) LeaveRealTime(tid);
    found = !threads.empty();
  }
  LeaveRealTime(0);
}

int MostPids() {
  int pid_max = kPidMaxByDefault;
  std::ifstream("/proc/sys/kernel/pid_max") >> pid_max;
  return pid_max;
}

}  // namespace tcs
