// Signals that the coordinator sends to threads of programs.
#pragma once

#include <sys/types.h>

#include <cstdint>

#include "shm/layout.h"

namespace tcs {

// With what the kernel would put into the signal of a timer; to a process, or one of its threads.
struct TimerSignalRequest {
  pid_t pid = 0, tid = 0;  // tid 0: to the process
  int number = 0, timer_id = 0, overruns = 0;
  std::int64_t value = 0;
};
void SendTimerSignal(const TimerSignalRequest& request);

// Tells a thread by a signal, which its shim has a handler for, to go to its gate. `dispatch` is
// its last one: in another one the signal says nothing. It is there once it has notified, and may
// never be.
void SendToGate(pid_t pid, pid_t tid, std::uint64_t dispatch);
// Has the thread look whether it spins, once it runs.
inline void AskWhere(pid_t pid, pid_t tid) { SendToGate(pid, tid, shm::kAsksWhere); }

}  // namespace tcs
