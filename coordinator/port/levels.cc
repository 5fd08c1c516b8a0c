#include "coordinator/port/levels.h"

#include <sched.h>
#include <sys/prctl.h>

#include <cstddef>

namespace tcs {

namespace {

bool uses_no_levels = false;

}  // namespace

bool BindTo(pid_t tid, int cpu) {
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(static_cast<std::size_t>(cpu), &one);
  return sched_setaffinity(tid, sizeof one, &one) == 0;
}

bool IsBoundTo(pid_t tid, int cpu) {
  cpu_set_t cpus;
  return sched_getaffinity(tid, sizeof cpus, &cpus) == 0 && CPU_COUNT(&cpus) == 1 &&
         CPU_ISSET(static_cast<std::size_t>(cpu), &cpus);
}

void UseNoLevels() { uses_no_levels = true; }

bool SetLevel(pid_t tid, Level level) {
  if (uses_no_levels) return false;
  const sched_param param{static_cast<int>(level)};
  return sched_setscheduler(tid, SCHED_FIFO, &param) == 0;
}

void RunOnlyWhenIdle(pid_t tid) {
  const sched_param param{0};
  sched_setscheduler(tid, SCHED_IDLE, &param);
}

void BeWokenInTime() { prctl(PR_SET_TIMERSLACK, 1, 0, 0, 0); }

void LeaveRealTime(pid_t tid) {
  const sched_param param{0};
  sched_setscheduler(tid, SCHED_OTHER, &param);
}

}  // namespace tcs
