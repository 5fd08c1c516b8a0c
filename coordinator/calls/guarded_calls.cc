#include "coordinator/calls/guarded_calls.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <string>

#include "coordinator/os/descendants.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/port/traps.h"

namespace tcs {

namespace {

// The process that a thread's descriptor stands for: a pidfd, or its folder in /proc; 0: none.
pid_t ProcessOfFd(pid_t tid, int number) {
  const std::string thread = "/proc/" + std::to_string(tid), fd = std::to_string(number);
  std::ifstream info(thread + "/fdinfo/" + fd);
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("Pid:", 0) == 0) return atoi(line.c_str() + 4);
  }
  char path[64];
  const ssize_t n = readlink((thread + "/fd/" + fd).c_str(), path, sizeof path - 1);
  constexpr char kProc[] = "/proc/";
  path[std::max<ssize_t>(n, 0)] = '\0';
  return strncmp(path, kProc, sizeof kProc - 1) == 0 ? atoi(path + sizeof kProc - 1) : 0;
}

bool MaySignal(const Credentials& sender, pid_t receiver) {
  constexpr int kCapKill = 5;
  if (sender.Has(kCapKill)) return true;
  const uid_t owner = ReadCredentials(receiver).real_uid;
  return owner == sender.real_uid || owner == sender.effective_uid;
}

// Sends the signal as kill would, with the caller as the sender.
bool SendAs(pid_t caller, const Credentials& sender, pid_t to, int signal) {
  siginfo_t info{};
  info.si_signo = signal;
  info.si_code = SI_QUEUE;
  info.si_pid = caller;
  info.si_uid = sender.real_uid;
  return syscall(SYS_rt_sigqueueinfo, to, signal, &info) == 0;
}

}  // namespace

bool GuardedCalls::IsGuarded(pid_t pid) const {
  return std::find(guarded_.begin(), guarded_.end(), pid) != guarded_.end();
}

// `receiver` is as kill understands it, except for the number of one process.
bool GuardedCalls::MeansGuarded(pid_t caller, pid_t receiver) const {
  if (receiver == -1) return true;
  const pid_t group = receiver == 0 ? getpgid(caller) : -receiver;
  return std::any_of(guarded_.begin(), guarded_.end(),
                     [group](pid_t pid) { return getpgid(pid) == group; });
}

// Sends the signal in the caller's stead, to the processes of the run that `receiver` means. So -1
// means all processes on the robots, as it would there.
std::int64_t GuardedCalls::SignalOurs(pid_t caller, pid_t receiver, int signal) const {
  if (signal < 0 || signal >= _NSIG) return -EINVAL;
  const Credentials sender = ReadCredentials(caller);
  const pid_t group = receiver == 0 ? getpgid(caller) : -receiver;
  bool found = false, sent = false;
  for (const pid_t pid : DescendantsOf(getpid())) {
    if (IsGuarded(pid) || is_beside_(pid)) continue;
    if (receiver == -1 ? pid == caller : getpgid(pid) != group) continue;
    found = true;
    sent |= MaySignal(sender, pid) && (signal == 0 || SendAs(caller, sender, pid, signal));
  }
  return sent ? 0 : found ? -EPERM : -ESRCH;
}

// The result of a call that the kernel must not carry out; none if the kernel may carry it out.
std::optional<std::int64_t> GuardedCalls::InsteadOfKernel(const TrappedCall& call) const {
  constexpr std::uint64_t kSetOwnerEx = 15;  // F_SETOWN_EX
  const auto refused_if = [](bool refused) -> std::optional<std::int64_t> {
    return refused ? std::optional<std::int64_t>(-EPERM) : std::nullopt;
  };
  const auto first = static_cast<int>(call.args[0]);
  switch (call.number) {
    case SYS_kill: {
      const pid_t caller = first > 0 ? 0 : ProcessOfThread(call.tid);
      if (first > 0 || !MeansGuarded(caller, first)) return std::nullopt;
      return SignalOurs(caller, first, static_cast<int>(call.args[1]));
    }
    case SYS_pidfd_send_signal:
    case SYS_pidfd_getfd:
    case SYS_process_madvise:
      return refused_if(IsGuarded(ProcessOfFd(call.tid, first)));
    case SYS_ptrace:  // the parent would be told of each signal, and does not ask
      return refused_if(call.args[0] == PTRACE_TRACEME &&
                        IsGuarded(ParentOf(ProcessOfThread(call.tid))));
    case SYS_fcntl: {
      struct {
        int type, pid;
      } owner{};
      if (call.args[1] != kSetOwnerEx ||
          !ReadMemory(call.tid, call.args[2], &owner, sizeof owner)) {
        return std::nullopt;
      }
      const pid_t pid = owner.type == F_OWNER_PGRP ? -owner.pid : owner.pid;
      return refused_if(IsGuarded(pid) || (pid < 0 && MeansGuarded(0, pid)));
    }
    case SYS_ioctl: {
      int owner = 0;
      if (!ReadMemory(call.tid, call.args[2], &owner, sizeof owner)) return std::nullopt;
      return refused_if(IsGuarded(owner) || (owner < 0 && MeansGuarded(0, owner)));
    }
    case SYS_sched_setscheduler:
    case SYS_sched_setparam:
    case SYS_sched_setattr:
    case SYS_sched_setaffinity:
      return 0;  // the host's scheduler does not hear of it, whoever calls
    case SYS_clock_settime:
    case SYS_settimeofday:
    case SYS_adjtimex:
    case SYS_clock_adjtime:
      return -EPERM;  // nor does its clock (date_calls.h)
    default:
      return std::nullopt;
  }
}

bool GuardedCalls::LetThrough(const TrappedCall& call) const {
  if (const auto result = InsteadOfKernel(call); result.has_value()) {
    return AnswerTrapped(call.listener, call.id, *result);
  }
  return ContinueTrapped(call.listener, call.id);
}

bool GuardedCalls::Continue(const Task& task) const {
  const TrappedCall& call = task.trapped_call;
  if (call.id == task.trap_id && call.listener == task.trap_listener) {
    return LetThrough(call);
  }
  return ContinueTrapped(task.trap_listener, task.trap_id);  // a futex call
}

}  // namespace tcs
