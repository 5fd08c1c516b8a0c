// Threads on the run's CPU that tcs knows nothing of: made by a bare clone that nobody has
// announced, or computing on after they have said that they end. They have the level of the thread
// that made them. One that computes for ever there would keep the CPU from those that are
// dispatched.
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <map>
#include <utility>

#include "coordinator/core/cpu_clock.h"
#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"
#include "coordinator/os/strays.h"

namespace tcs {

namespace {

// Of processor time: for so long time waits for a thread that has no level any more.
constexpr std::int64_t kCountsNs = 1'000'000'000;
// Of processor time between two looks: whoever has used less does not keep the CPU from others.
constexpr std::int64_t kComputesNs = 10'000'000;

std::int64_t ClockOf(pid_t tid) {
  const UniqueFd clock(OpenThreadCpuClock(tid));
  return clock ? ReadThreadCpuClock(clock.get()) : -1;
}

bool IsOwnThread(pid_t tid) { return syscall(SYS_tgkill, getpid(), tid, 0) == 0; }

}  // namespace

// The dispatched thread has not had the CPU for a while. Others of the host may have it, too: so an
// unknown thread loses its level only if it has computed since the look before, in this dispatch.
void Engine::LowerUnknownThreads() {
  const std::map<pid_t, std::int64_t> before = std::exchange(unknown_threads_.used_ns, {});
  const bool is_first =
      std::exchange(unknown_threads_.dispatch, report_.switches) != report_.switches;
  for (const pid_t tid : RealTimeThreadsOn(claim_.cpu, most_pids_)) {
    if (KnownTask(tid) != nullptr || tid == host_cpu_.detector().pid() || IsOwnThread(tid))
      continue;
    const std::int64_t used_ns = ClockOf(tid);
    const auto seen = before.find(tid);
    if (!is_first && seen != before.end() && used_ns - seen->second >= kComputesNs) {
      Lower(tid);
    } else {
      unknown_threads_.used_ns[tid] = used_ns;
    }
  }
}

void Engine::Lower(pid_t tid) {
  LeaveRealTime(tid);
  lowered_[tid] = ClockOf(tid) + kCountsNs;
  const Process* process = LivingProcess(ProcessOfThread(tid));
  Warn((process == nullptr ? "a process that " + NameOfMakerOf(tid) + " has started"
                           : "a thread of " + process->name) +
       " computes on and on, and tcs was told nothing of it, or that it ends; it is not scheduled "
       "any more, and gets what others leave");
}

// A thread of a process that has registered does so itself before it computes anything.
bool Engine::NeverRegisters(Task& task) {
  return task.process->link != nullptr && HostClockOf(task) > kCountsNs;
}

// It has had its time, and is not waited for any more.
bool Engine::IsAstray(pid_t tid) const {
  const auto found = lowered_.find(tid);
  if (found == lowered_.end()) return false;
  const std::int64_t used_ns = ClockOf(tid);
  return used_ns < 0 || used_ns > found->second;
}

std::string Engine::NameOfMakerOf(pid_t tid) {
  const Process* maker = LivingProcess(ParentOf(ProcessOfThread(tid)));
  return maker == nullptr ? "a program of the run" : maker->name;
}

}  // namespace tcs
