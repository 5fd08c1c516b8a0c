#include "coordinator/processes/unregistered_threads.h"

#include <sys/syscall.h>
#include <unistd.h>

#include <utility>

#include "coordinator/port/clocks.h"
#include "coordinator/port/levels.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/tasks/cpu_clock.h"

namespace tcs {

namespace {

// Of processor time: for so long time waits for a thread that has no level any more.
constexpr std::int64_t kCountsNs = 1'000'000'000;
// Of processor time between two looks: a thread that has used less does not keep the CPU from
// others.
constexpr std::int64_t kComputesNs = 10'000'000;

std::int64_t ClockOf(pid_t tid) {
  const UniqueFd clock(OpenThreadCpuClock(tid));
  return clock ? ReadThreadCpuClock(clock.get()) : -1;
}

bool IsOwnThread(pid_t tid) { return syscall(SYS_tgkill, getpid(), tid, 0) == 0; }

}  // namespace

void UnregisteredThreads::LowerThoseThatCompute(int cpu, pid_t detector) {
  const std::map<pid_t, std::int64_t> before = std::exchange(seen_used_ns_, {});
  const std::int64_t dispatch = run_.report.switches;
  const bool is_first = std::exchange(seen_dispatch_, dispatch) != dispatch;
  for (const pid_t tid : RealTimeThreadsOn(cpu, most_pids_)) {
    if (run_.table.Living(tid) != nullptr || tid == detector || IsOwnThread(tid)) continue;
    const std::int64_t used_ns = ClockOf(tid);
    const auto seen = before.find(tid);
    if (!is_first && seen != before.end() && used_ns - seen->second >= kComputesNs) {
      Lower(tid);
    } else {
      seen_used_ns_[tid] = used_ns;
    }
  }
}

void UnregisteredThreads::Lower(pid_t tid) {
  LeaveRealTime(tid);
  lowered_[tid] = ClockOf(tid) + kCountsNs;
  const Process* process = run_.table.LivingProcess(ProcessOfThread(tid));
  run_.Warn(
      (process == nullptr ? "a process that " + NameOfMakerOf(tid) + " has started"
                          : "a thread of " + process->name) +
      " computes on and on, and tcs was told nothing of it, or that it ends; it is not scheduled "
      "any more, and gets what others leave");
}

bool UnregisteredThreads::NeverRegisters(Task& task) {
  return task.process->link != nullptr && HostClockOf(task) > kCountsNs;
}

bool UnregisteredThreads::IsAstray(pid_t tid) const {
  const auto found = lowered_.find(tid);
  if (found == lowered_.end()) return false;
  const std::int64_t used_ns = ClockOf(tid);
  return used_ns < 0 || used_ns > found->second;
}

bool UnregisteredThreads::AnyRuns() const {
  if (!run_.had_unregistered_threads) return false;
  for (const Process& process : run_.table.processes()) {
    if (!process.has_unregistered_threads || process.dead) continue;
    for (const pid_t tid : ThreadsOf(process.pid)) {
      if (run_.table.Living(tid) != nullptr || IsAstray(tid)) continue;
      if (const char state = ThreadState(tid); state == 'R' || state == 'D') return true;
    }
  }
  return false;
}

std::string UnregisteredThreads::NameOfMakerOf(pid_t tid) const {
  const Process* maker = run_.table.LivingProcess(ParentOf(ProcessOfThread(tid)));
  return maker == nullptr ? "a program of the run" : maker->name;
}

}  // namespace tcs
