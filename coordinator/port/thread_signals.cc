#include "coordinator/port/thread_signals.h"

#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace tcs {

void SendTimerSignal(const TimerSignalRequest& request) {
  // The kernel lets one process send this code to another.
  static_assert(SI_TIMER < 0);
  siginfo_t info{};
  info.si_signo = request.number;
  info.si_code = SI_TIMER;
  info.si_timerid = request.timer_id;
  info.si_overrun = request.overruns;
  info.si_value.sival_ptr = reinterpret_cast<void*>(request.value);
  if (request.tid == 0) {
    syscall(SYS_rt_sigqueueinfo, request.pid, request.number, &info);
  } else {
    syscall(SYS_rt_tgsigqueueinfo, request.pid, request.tid, request.number, &info);
  }
}

void SendToGate(pid_t pid, pid_t tid, std::uint64_t dispatch) {
  siginfo_t info{};
  info.si_signo = shm::kPreemptionSignal;
  info.si_code = SI_QUEUE;
  info.si_pid = getpid();
  info.si_value.sival_ptr = reinterpret_cast<void*>(dispatch);
  syscall(SYS_rt_tgsigqueueinfo, pid, tid, shm::kPreemptionSignal, &info);
}

}  // namespace tcs
