// Signals that the coordinator sends to threads of programs.
#pragma once

#include <sys/types.h>

#include <cstdint>

#include "shm/layout.h"

namespace tcs {

// The signal has what the kernel would put into the signal of a timer; it goes to a process, or to
// one of its threads.
struct TimerSignalRequest {
  pid_t pid = 0, tid = 0;  // tid 0: to the process
  int number = 0, timer_id = 0, overruns = 0;
  std::int64_t value = 0;
};
void SendTimerSignal(const TimerSignalRequest& request);

// Tells a thread by a signal, which its shim has a handler for, to go to its gate. `dispatch` is
// the thread's last one: in another dispatch the signal says nothing. The thread is at its gate
// once it has notified, and may never be.
void SendToGate(pid_t pid, pid_t tid, std::uint64_t dispatch);
// Has the thread look whether it spins, once it runs.
inline void AskWhere(pid_t pid, pid_t tid) { SendToGate(pid, tid, shm::kAsksWhere); }

}  // namespace tcs
