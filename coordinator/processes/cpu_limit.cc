#include "coordinator/processes/cpu_limit.h"

#include <algorithm>

#include "shm/time_values.h"

namespace tcs {

namespace {

// 0 would be no limit.
std::int64_t ToLimitNs(rlim_t seconds) {
  constexpr rlim_t kMost = shm::kFarNs / shm::kNsPerSecond;
  if (seconds > kMost) return 0;
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(seconds) * shm::kNsPerSecond);
}

}  // namespace

rlimit CpuLimitOf(const Process& process) {
  if (!process.most_cpu_s.has_value()) {
    rlimit of_host{RLIM_INFINITY, RLIM_INFINITY};
    prlimit(process.pid, RLIMIT_CPU, nullptr, &of_host);
    return of_host;
  }
  const std::int64_t next_ns = process.timers.Get(ProcessTimers::kCpuLimit).next_ns;
  return {next_ns == 0 ? RLIM_INFINITY : static_cast<rlim_t>(next_ns / shm::kNsPerSecond),
          *process.most_cpu_s};
}

void SetCpuLimit(Process& process, const rlimit& limit) {
  process.most_cpu_s = limit.rlim_max;
  const VirtualDuration lead = process.clock.lead();
  process.timers.Set(ProcessTimers::kCpuLimit, {ToLimitNs(limit.rlim_cur), shm::kNsPerSecond},
                     lead);
  process.timers.Set(ProcessTimers::kMostCpu, {ToLimitNs(limit.rlim_max), 0}, lead);
}

void InheritCpuLimit(const Process& parent, Process& child) {
  if (parent.most_cpu_s.has_value()) SetCpuLimit(child, CpuLimitOf(parent));
}

}  // namespace tcs
