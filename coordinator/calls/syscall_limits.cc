#include "coordinator/calls/syscall_limits.h"

#include <errno.h>
#include <sys/syscall.h>

#include "coordinator/os/own_number.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/port/traps.h"
#include "coordinator/processes/cpu_limit.h"
#include "coordinator/tasks/client_values.h"

namespace tcs {

namespace {

bool HasRight(const Credentials& caller) {
  constexpr int kCapSysResource = 24;
  return caller.Has(kCapSysResource);
}

// As prlimit demands of a process that asks about another one.
bool MayLookAt(const Credentials& caller, const Process& process) {
  const Credentials its = ReadCredentials(process.pid);
  return HasRight(caller) ||
         (caller.real_uid == its.real_uid && caller.real_uid == its.effective_uid);
}

}  // namespace

std::int64_t SyscallLimits::Call(Task& task, const TrappedCall& call) const {
  Process* process = task.process;
  std::uint64_t given = 0, asked = 0;
  if (call.number == SYS_prlimit64) {
    auto pid = static_cast<pid_t>(call.args[0]);
    // A process in a PID namespace of its own gets an answer about itself only.
    if (pid != 0 && process->pid_namespace != 0) {
      pid = ThreadByOwnNumber(process->pid, pid) == process->pid ? process->pid : -1;
    }
    if (pid != 0 && pid != process->pid) {
      const Task* other = run_.table.Living(pid);
      process = other != nullptr ? other->process : run_.table.LivingProcess(pid);
    }
    given = call.args[2];
    asked = call.args[3];
  } else {
    (call.number == SYS_setrlimit ? given : asked) = call.args[1];
    if (call.args[1] == 0) return -EFAULT;
  }
  if (process == nullptr) {
    task.trap_continues = true;  // a process of another run, or of nobody
    return 0;
  }
  rlimit limit{};
  if (given != 0 && !Read(task, given, &limit)) return -EFAULT;
  const Credentials caller = ReadCredentials(task.tid);
  if (process != task.process && !MayLookAt(caller, *process)) return -EPERM;
  const rlimit before = CpuLimitOf(*process);
  if (given != 0) {
    if (limit.rlim_cur > limit.rlim_max) return -EINVAL;
    if (limit.rlim_max > before.rlim_max && !HasRight(caller)) return -EPERM;
    SetCpuLimit(*process, limit);
  }
  return asked == 0 || Write(task, asked, before) ? 0 : -EFAULT;
}

}  // namespace tcs
