#include "coordinator/calls/syscall_usage.h"

#include <errno.h>
#include <sys/resource.h>
#include <sys/sysinfo.h>
#include <sys/times.h>
#include <unistd.h>

#include <optional>

#include "coordinator/processes/usage_book.h"
#include "coordinator/tasks/client_values.h"
#include "shm/clock_ids.h"

namespace tcs {

namespace {

// None: the clock is of nobody here.
std::optional<std::int64_t> ChargedNs(const RunState& run, const Task& task,
                                      const shm::ClockOfId& clock) {
  if (clock.kind == shm::ClockKind::kThreadCpu) {
    const Task* of = clock.owner == 0 ? &task : run.table.Living(clock.owner);
    if (of == nullptr || of->process != task.process) return std::nullopt;
    return of->charged.ns();
  }
  const Process* of = clock.owner == 0 ? task.process : run.table.LivingProcess(clock.owner);
  if (of == nullptr) return std::nullopt;
  return UsageBook::ChargedTo(*of).ns();
}

}  // namespace

std::int64_t SyscallUsage::ReadClock(Task& task, const TrappedCall& call) const {
  const shm::ClockOfId clock = shm::ClockOf(static_cast<clockid_t>(call.args[0]));
  const std::optional<std::int64_t> charged = ChargedNs(run_, task, clock);
  if (!charged.has_value()) {
    task.trap_continues = true;  // the kernel knows the clock, or that there is none
    return 0;
  }
  return Write(task, call.args[1], ToTimespec(*charged)) ? 0 : -EFAULT;
}

void SyscallUsage::Fill(const KernelUsage& counted, std::int64_t charged_ns, rusage& usage) const {
  const std::int64_t ticks = counted.user_ticks + counted.system_ticks;
  const double user_part = run_.IsFixed() || ticks == 0 ? 1.0
                                                        : static_cast<double>(counted.user_ticks) /
                                                              static_cast<double>(ticks);
  const auto user_ns = static_cast<std::int64_t>(static_cast<double>(charged_ns) * user_part);
  usage.ru_utime = shm::ToTimeval(user_ns);
  usage.ru_stime = shm::ToTimeval(charged_ns - user_ns);
  usage.ru_maxrss = counted.peak_kib;
  usage.ru_minflt = counted.minor_faults;
  usage.ru_majflt = counted.major_faults;
  usage.ru_nvcsw = counted.waits;
  usage.ru_nivcsw = counted.preemptions;
}

std::int64_t SyscallUsage::GetUsage(const Task& task, const TrappedCall& call) const {
  const pid_t pid = task.process->pid;
  rusage usage{};
  switch (static_cast<int>(call.args[0])) {
    case RUSAGE_SELF:
      Fill(KernelUsageOfProcess(pid), UsageBook::ChargedTo(*task.process).ns(), usage);
      break;
    case RUSAGE_CHILDREN:
      Fill(KernelUsageOfChildren(pid), task.process->children_cpu.ns(), usage);
      break;
    case RUSAGE_THREAD:
      Fill(KernelUsageOfThread(pid, task.tid), task.charged.ns(), usage);
      break;
    default:
      return -EINVAL;
  }
  return Write(task, call.args[1], usage) ? 0 : -EFAULT;
}

std::int64_t SyscallUsage::Times(const Task& task, const TrappedCall& call) const {
  const std::int64_t tick = shm::kNsPerSecond / sysconf(_SC_CLK_TCK);
  const tms times{.tms_utime = UsageBook::ChargedTo(*task.process).ns() / tick,
                  .tms_stime = 0,
                  .tms_cutime = task.process->children_cpu.ns() / tick,
                  .tms_cstime = 0};
  if (call.args[0] != 0 && !Write(task, call.args[0], times)) return -EFAULT;
  return UptimeNs(task) / tick;
}

std::int64_t SyscallUsage::SystemInfo(const Task& task, const TrappedCall& call) const {
  struct sysinfo info {};
  if (sysinfo(&info) != 0) return -errno;
  info.uptime = (UptimeNs(task) + shm::kNsPerSecond - 1) / shm::kNsPerSecond;  // as the kernel does
  return Write(task, call.args[0], info) ? 0 : -EFAULT;
}

std::int64_t SyscallUsage::UptimeNs(const Task& task) const {
  return OwnNow(task).ns() + run_.header->monotonic_offset_ns;
}

}  // namespace tcs
