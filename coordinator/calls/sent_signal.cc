#include "coordinator/calls/sent_signal.h"

#include <signal.h>
#include <sys/syscall.h>

#include <algorithm>
#include <optional>

#include "coordinator/os/signal_bits.h"

namespace tcs {

namespace {

int Arg(const TrappedCall& call, int index) { return static_cast<int>(call.args[index]); }

// None: the call sends no signal.
std::optional<int> SignalIn(const TrappedCall& call) {
  switch (call.number) {
    case SYS_kill:
    case SYS_tkill:
    case SYS_rt_sigqueueinfo:
    case SYS_pidfd_send_signal:
      return Arg(call, 1);
    case SYS_tgkill:
    case SYS_rt_tgsigqueueinfo:
      return Arg(call, 2);
    default:
      return std::nullopt;
  }
}

// By the numbers that the sender's process says; the kernel takes the number of any thread for that
// of its process.
SentSignal Sent(RunState& run, const Task& by, pid_t pid, pid_t tid, int number) {
  const Task* thread = tid > 0 ? run.table.Named(*by.process, tid) : nullptr;
  const Task* in_process = pid > 0 ? run.table.Named(*by.process, pid) : thread;
  const bool is_own_number = by.process->pid_namespace == 0;
  return {.pid = in_process != nullptr ? in_process->process->pid
                 : is_own_number       ? std::max(pid, 0)
                                       : 0,
          .tid = thread != nullptr ? thread->tid : 0,
          .number = tid > 0 && thread == nullptr ? 0 : number,  // else it would be its process's
          .is_to_itself = thread == &by};
}

}  // namespace

bool SentSignal::MayStop() const {
  return number <= 0 || (SignalBit(number) & (kStopSignals | SignalBit(SIGCONT))) != 0;
}

SentSignal SentBy(RunState& run, const Task& task, const shm::Notification& note) {
  const auto& args = note.args;
  return Sent(run, task, static_cast<pid_t>(args[0]), static_cast<pid_t>(args[1]),
              static_cast<int>(args[2]));
}

SentSignal SentBy(RunState& run, const Task& task, const TrappedCall& call) {
  const auto number = SignalIn(call);
  if (!number.has_value()) return {};
  switch (call.number) {
    case SYS_kill:
    case SYS_rt_sigqueueinfo:
      return Sent(run, task, Arg(call, 0), 0, *number);
    case SYS_tgkill:
    case SYS_rt_tgsigqueueinfo:
      return Sent(run, task, Arg(call, 0), Arg(call, 1), *number);
    case SYS_tkill:
      return Sent(run, task, 0, Arg(call, 0), *number);
    default:  // by a pidfd, which may be a thread's
      return {};
  }
}

bool OnlyAsks(const TrappedCall& call) { return SignalIn(call) == 0; }

}  // namespace tcs
